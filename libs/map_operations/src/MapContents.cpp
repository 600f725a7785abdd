#include <map_operations/MapOperations.h>

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

}  // namespace semantic_octree
