#include <map_operations/MapOperations.h>
#include <semantic_octree/store/TreeBuilder.h>

#include <stdexcept>
#include <string>

namespace semantic_octree {

MapContents contentsOf(const SemanticOcTree& tree) {
  MapContents contents;
  contents.bytes = tree.memoryUsage();
  contents.voxelsOfClass.assign(tree.numClasses() + 1, 0);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ++contents.leaves;
    const std::uint64_t voxels = std::uint64_t(1) << 3 * (tree.getTreeDepth() - leaf.getDepth());
    const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(leaf.getSize() / 2);
    contents.box.extend(center - half).extend(center + half);
    const CellState state = tree.query(*leaf);
    if (state.status != CellState::Status::Occupied) {
      contents.freeVoxels += voxels;
      continue;
    }
    contents.occupiedVoxels += voxels;
    contents.voxelsOfClass[state.likeliestClass] += voxels;
  }
  contents.innerNodes = tree.size() - contents.leaves;
  return contents;
}

namespace {

/** A map's nodes as they are. */
class CopyCursor {
 public:
  CopyCursor(int numClasses, const Node& node) : m_numClasses(numClasses), m_node(node) {}
  bool known() const { return static_cast<bool>(m_node); }
  bool isLeaf() const { return m_node.isLeaf(); }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }
  CopyCursor child(int i) const {
    return {m_numClasses, m_node.isLeaf() ? m_node : m_node.child(i)};
  }

 private:
  int m_numClasses;
  Node m_node;
};

/** Range of voxels, as keys, both ends included. */
struct VoxelBox {
  VoxelIndex first, last;
};

class CropCursor {
 public:
  CropCursor(int numClasses, const VoxelBox& box, const Node& node, const Cell& cell)
      : m_numClasses(numClasses), m_box(box), m_node(node), m_cell(cell) {}

  bool known() const {
    return m_node && (m_cell.lowest() <= m_box.last).all() && (highest() >= m_box.first).all();
  }
  bool isLeaf() const {
    return m_node.isLeaf() && (m_cell.lowest() >= m_box.first).all() &&
           (highest() <= m_box.last).all();
  }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }
  CropCursor child(int i) const {
    const Node node = m_node.isLeaf() ? m_node : m_node.child(i);
    return {m_numClasses, m_box, node, m_cell.child(i)};
  }

 private:
  VoxelIndex highest() const { return m_cell.lowest() + (m_cell.edge() - 1); }

  int m_numClasses;
  const VoxelBox& m_box;
  Node m_node;
  Cell m_cell;
};

/** Voxels whose centers are in a box. */
VoxelBox voxelsIn(const Eigen::AlignedBox3d& box, double resolution) {
  const Eigen::Array3d limit = Eigen::Array3d::Constant(kKeyOfOrigin);
  const auto toKeys = [&](const Eigen::Array3d& voxels) {
    return VoxelIndex((voxels.max(-limit).min(limit) + limit).cast<int>());
  };
  return {toKeys((box.min().array() / resolution - 0.5).ceil()),
          toKeys((box.max().array() / resolution - 0.5).floor())};
}

/** A cube of the coarse map and the node of the fine map for it. The fine map fills the middle of
 * the coarse one: down to depth `levels` the cubes that touch the middle hold one octant of it
 * each, and `node` is still the fine map's root. */
class CoarseCursor {
 public:
  CoarseCursor(const SemanticOcTree& map, int levels)
      : CoarseCursor(map.numClasses(), levels, map.root(), 0, -1) {}

  bool known() const { return static_cast<bool>(m_node); }
  bool isLeaf() const { return m_depth == kTreeDepth || (m_depth > m_levels && m_node.isLeaf()); }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }

  CoarseCursor child(int i) const {
    if (m_depth < m_levels) {
      const bool towardsMiddle = m_depth == 0 || i == 7 - m_octant;
      const int octant = m_depth == 0 ? i : m_octant;
      return {m_numClasses, m_levels, towardsMiddle ? m_node : Node(), m_depth + 1, octant};
    }
    if (m_depth == m_levels && m_depth > 0)
      return {m_numClasses, m_levels, i == 7 - m_octant ? childNode(m_octant) : Node(), m_depth + 1,
              -1};
    return {m_numClasses, m_levels, childNode(i), m_depth + 1, -1};
  }

 private:
  CoarseCursor(int numClasses, int levels, const Node& node, int depth, int octant)
      : m_numClasses(numClasses),
        m_levels(levels),
        m_node(node),
        m_depth(depth),
        m_octant(octant) {}

  Node childNode(int i) const { return m_node.isLeaf() ? m_node : m_node.child(i); }

  int m_numClasses;
  int m_levels;
  Node m_node;
  int m_depth, m_octant;
};

}  // namespace

void copyTo(SemanticOcTree& copy, const SemanticOcTree& map) {
  TreeBuilder::checkTarget(copy, map);
  TreeBuilder::fill(copy, CopyCursor(map.numClasses(), map.root()), TreeBuilder::Merge::Never);
}

SemanticOcTree cropped(const SemanticOcTree& map, const Eigen::AlignedBox3d& box) {
  if (!(box.min().array() <= box.max().array()).all())
    throw std::invalid_argument("cropping: the box is empty, or not a number");
  SemanticOcTree part = emptyLike(map);
  const VoxelBox voxels = voxelsIn(box, map.getResolution());
  TreeBuilder::fill(part, CropCursor(map.numClasses(), voxels, map.root(), Cell()));
  return part;
}

SemanticOcTree coarsened(const SemanticOcTree& map, int levels) {
  if (levels < 0 || levels > 8)
    throw std::invalid_argument("coarsening: levels = " + std::to_string(levels) +
                                ", expected 0 to 8");
  SemanticOcTree coarse = MapAccess::emptyWith(map, map.getResolution() * (1 << levels));
  TreeBuilder::fill(coarse, CoarseCursor(map, levels));
  return coarse;
}

}  // namespace semantic_octree
