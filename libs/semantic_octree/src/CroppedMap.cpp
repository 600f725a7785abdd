#include <semantic_octree/MapOperations.h>

#include <stdexcept>

#include "TreeBuilder.h"

namespace semantic_octree {
namespace {

/** Range of voxels, as keys, both ends included. */
struct VoxelBox {
  VoxelIndex first, last;
};

class CropCursor {
 public:
  CropCursor(const SemanticOcTree& map, const VoxelBox& box, const Node* node, const Cell& cell)
      : m_map(map), m_box(box), m_node(node), m_cell(cell) {}

  bool known() const {
    return m_node && (m_cell.lowest() <= m_box.last).all() && (highest() >= m_box.first).all();
  }
  bool isLeaf() const {
    return m_node->isLeaf() && (m_cell.lowest() >= m_box.first).all() &&
           (highest() <= m_box.last).all();
  }
  LeafContent content() const { return contentOf(m_map, *m_node); }
  CropCursor child(int i) const {
    const Node* node = m_node->isLeaf() ? m_node : NodeStore::child(*m_node, i);
    return {m_map, m_box, node, m_cell.child(i)};
  }

 private:
  VoxelIndex highest() const { return m_cell.lowest() + (m_cell.edge() - 1); }

  const SemanticOcTree& m_map;
  const VoxelBox& m_box;
  const Node* m_node;
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

}  // namespace

SemanticOcTree cropped(const SemanticOcTree& map, const Eigen::AlignedBox3d& box) {
  if (!(box.min().array() <= box.max().array()).all())
    throw std::invalid_argument("cropping: the box is empty, or not a number");
  SemanticOcTree part = TreeBuilder::emptyLike(map);
  const VoxelBox voxels = voxelsIn(box, map.getResolution());
  TreeBuilder::fill(part, CropCursor(map, voxels, map.root(), Cell()));
  return part;
}

}  // namespace semantic_octree
