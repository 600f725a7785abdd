#pragma once
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTree.h>

namespace map_pictures {

using semantic_octree::Cube;

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
