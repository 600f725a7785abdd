#include <map_operations/MapOperations.h>

#include <semantic_octree/store/TreeBuilder.h>
#include <strict_files/OptionList.h>

#include <cmath>
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

/** Range of voxels, as keys, both ends included. */
struct VoxelBox {
  VoxelIndex first = VoxelIndex::Constant(0), last = VoxelIndex::Constant(kNumKeys - 1);
};

/** A map's nodes in a box, as they are. */
class CropCursor {
 public:
  CropCursor(int numClasses, const VoxelBox& box, const Node& node, const Cube& cell)
      : m_numClasses(numClasses), m_box(box), m_node(node), m_cell(cell) {}

  bool known() const {
    return m_node && (m_cell.lowest <= m_box.last).all() && (highest() >= m_box.first).all();
  }
  bool isLeaf() const {
    return m_node.isLeaf() && (m_cell.lowest >= m_box.first).all() &&
           (highest() <= m_box.last).all();
  }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }
  CropCursor child(int i) const {
    const Node node = m_node.isLeaf() ? m_node : m_node.child(i);
    return {m_numClasses, m_box, node, m_cell.child(i)};
  }

 private:
  VoxelIndex highest() const { return m_cell.lowest + (m_cell.edge() - 1); }

  int m_numClasses;
  const VoxelBox& m_box;
  Node m_node;
  Cube m_cell;
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
 * the coarse one. Down to depth `levels` the cubes that touch the middle hold one octant of it
 * each; `node` is still the fine map's root. */
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
    const bool isEdge = m_depth == m_levels && m_depth > 0;
    const Node node = !isEdge ? childNode(i) : i == 7 - m_octant ? childNode(m_octant) : Node();
    return {m_numClasses, m_levels, node, m_depth + 1, -1};
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

namespace {

std::string pointText(const Eigen::Vector3d& p) {
  using strict_files::textOf;
  return textOf(p.x()) + "," + textOf(p.y()) + "," + textOf(p.z());
}

/** A result whose borders cut leaves of the map, which may be as large as towns. Its cubes come of
 * a million cut ones at most, and of what grows with the map. */
template <class Cursor>
void fillCut(SemanticOcTree& result, const Cursor& cursor, const SemanticOcTree& map) {
  const std::uint64_t most = (std::uint64_t{1} << 20) + 64 * std::uint64_t{map.size()};
  TreeBuilder::fill(result, cursor, TreeBuilder::Merge::AsTheMapDoes, most);
}

}  // namespace

void copyTo(SemanticOcTree& copy, const SemanticOcTree& map) {
  TreeBuilder::checkTarget(copy, map);
  const VoxelBox all;
  TreeBuilder::fill(copy, CropCursor(map.numClasses(), all, map.root(), Cube()),
                    TreeBuilder::Merge::Never);
}

SemanticOcTree cropped(const SemanticOcTree& map, const Eigen::AlignedBox3d& box) {
  if (!(box.min().array() <= box.max().array()).all())
    throw std::invalid_argument("cropping: the box from " + pointText(box.min()) + " to " +
                                pointText(box.max()) + " m is empty, or not a number");
  SemanticOcTree part = emptyLike(map);
  const VoxelBox voxels = voxelsIn(box, map.getResolution());
  fillCut(part, CropCursor(map.numClasses(), voxels, map.root(), Cube()), map);
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

namespace {

/** Axis-aligned box in voxels of the old map, as keys with fractions. */
using Bounds = Eigen::AlignedBox3d;

Bounds boundsOf(const Cube& cell) {
  const Eigen::Vector3d low = cell.lowest.cast<double>();
  return {low, low + Eigen::Vector3d::Constant(cell.edge())};
}

/** Whether any known leaf below a node overlaps the bounds. */
bool anyKnown(const Node& node, const Cube& cell, const Bounds& bounds) {
  if (!node || !boundsOf(cell).intersects(bounds)) return false;
  if (node.isLeaf()) return true;
  for (int i = 0; i < 8; ++i)
    if (anyKnown(node.child(i), cell.child(i), bounds)) return true;
  return false;
}

/** Poses in voxels, as keys, and the map that is moved. */
struct Move {
  const SemanticOcTree& map;
  Eigen::Isometry3d T_old_new;
  Eigen::Matrix3d absoluteRotation;
};

/** A cube of the new map, and the smallest node of the old one that holds all of it. */
class MoveCursor {
 public:
  explicit MoveCursor(const Move& move) : MoveCursor(move, Cube(), move.map.root(), Cube()) {}

  bool known() const {
    return m_cell.depth == kTreeDepth ? static_cast<bool>(m_node)
                                      : anyKnown(m_node, m_nodeCell, bounds());
  }
  bool isLeaf() const { return m_node.isLeaf(); }
  LeafContent content() const { return contentOf(m_node, m_move.map.numClasses()); }
  MoveCursor child(int i) const { return {m_move, m_cell.child(i), m_node, m_nodeCell}; }

 private:
  MoveCursor(const Move& move, const Cube& cell, const Node& node, const Cube& nodeCell)
      : m_move(move), m_cell(cell), m_node(node), m_nodeCell(nodeCell) {
    while (m_node && !m_node.isLeaf() && descend()) continue;
  }

  /** To the child that holds the whole cube, or the center if the cube is a voxel. */
  bool descend() {
    const Bounds b = bounds();
    const Eigen::Vector3d middle = m_nodeCell.lowest.cast<double>().matrix() +
                                   Eigen::Vector3d::Constant(m_nodeCell.edge() / 2);
    const auto low = (b.min().array() >= middle.array()).eval();
    const auto high = (b.max().array() > middle.array()).eval();
    if (m_nodeCell.depth == 0 && !boundsOf(m_nodeCell).contains(b)) return false;
    if ((low != high).any()) return false;
    const int i = low[0] | low[1] << 1 | low[2] << 2;
    m_node = m_node.child(i);
    m_nodeCell = m_nodeCell.child(i);
    return true;
  }

  /** Bounds of the cube in the old map; a voxel counts as its center. */
  Bounds bounds() const {
    const double half = m_cell.depth == kTreeDepth ? 0 : m_cell.edge() / 2.0;
    const Eigen::Vector3d center =
        m_move.T_old_new *
        (m_cell.lowest.cast<double>().matrix() + Eigen::Vector3d::Constant(m_cell.edge() / 2.0));
    const Eigen::Vector3d reach = m_move.absoluteRotation * Eigen::Vector3d::Constant(half);
    return {center - reach, center + reach};
  }

  const Move& m_move;
  Cube m_cell;
  Node m_node;
  Cube m_nodeCell;
};

/** A pose in meters as one in keys. */
Eigen::Isometry3d inVoxels(const Eigen::Isometry3d& T, double resolution) {
  const Eigen::Vector3d middle = Eigen::Vector3d::Constant(kKeyOfOrigin);
  Eigen::Isometry3d scaled = T;
  scaled.translation() = T.translation() / resolution + middle - T.linear() * middle;
  return scaled;
}

void checkRigid(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  const double error = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error < 1e-6) || !(R.determinant() > 0) || !T.translation().allFinite())
    throw std::invalid_argument("moving a map: the pose is not a rigid transformation");
}

/** The corners of the known space must stay inside the new map's cube. */
void checkStaysInside(const SemanticOcTree& map, const Eigen::Isometry3d& T_new_old) {
  Eigen::Vector3d low, high;
  map.getMetricMin(low.x(), low.y(), low.z());
  map.getMetricMax(high.x(), high.y(), high.z());
  const Eigen::AlignedBox3d known(low, high);
  const double limit = (kKeyOfOrigin - 1) * map.getResolution();
  for (int i = 0; i < 8; ++i) {
    const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
    if (((T_new_old * known.corner(corner)).cwiseAbs().array() > limit).any())
      throw std::out_of_range("moving a map: it would reach beyond " + strict_files::textOf(limit) +
                              " m, the border of its 16 levels");
  }
}

}  // namespace

SemanticOcTree moved(const SemanticOcTree& map, const Eigen::Isometry3d& T_new_old) {
  checkRigid(T_new_old);
  SemanticOcTree result = emptyLike(map);
  if (map.empty()) return result;
  checkStaysInside(map, T_new_old);
  const Eigen::Isometry3d T = inVoxels(T_new_old.inverse(), map.getResolution());
  const Move move{map, T, T.linear().cwiseAbs()};
  fillCut(result, MoveCursor(move), map);
  return result;
}

}  // namespace semantic_octree
