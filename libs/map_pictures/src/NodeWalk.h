#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Core>

namespace map_pictures {

/** What a node stands for. */
struct Cube {
  Eigen::Array3i lowest{0, 0, 0};  ///< keys of its lowest voxel
  int depth = 0;

  /** In voxels. */
  int edge() const { return semantic_octree::edgeAtDepth(depth); }
  /** m */
  Eigen::Vector3d center(double voxelSize) const {
    const auto along = [&](int axis) {
      return semantic_octree::centerOf(lowest[axis], voxelSize, depth);
    };
    return {along(0), along(1), along(2)};
  }
  Cube child(int i) const {
    return {lowest + Eigen::Array3i(i & 1, i >> 1 & 1, i >> 2) * (edge() / 2), depth + 1};
  }
};

/** Calls visit(node, cube) for a map's nodes, in OctoMap's order; goes below a node only if it is
 * told to. (OctoMap's iterators go everywhere.) */
template <class Visit>
void forEachNode(const semantic_octree::SemanticOcTree& tree, const Visit& visit) {
  const auto walk = [&visit](const auto& self, const semantic_octree::SemanticOcTreeNode& node,
                             const Cube& cube) -> void {
    if (!visit(node, cube) || node.isLeaf()) return;
    for (int i = 0; i < 8; ++i)
      if (const auto child = node.child(i)) self(self, child, cube.child(i));
  };
  if (!tree.empty()) walk(walk, tree.root(), Cube());
}

}  // namespace map_pictures
