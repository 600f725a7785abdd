#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** How much of what is in a map. A voxel is a cell of the map's resolution: a leaf above the lowest
 * level counts as all voxels in it, so that pruning does not change the numbers. */
struct MapContents {
  std::size_t leaves = 0, innerNodes = 0;
  /** See SemanticOcTree::memoryUsage(). */
  std::size_t bytes = 0;
  std::uint64_t freeVoxels = 0, occupiedVoxels = 0;
  /** K + 1 numbers of occupied voxels by their likeliest class; [0]: no class was ever seen. */
  std::vector<std::uint64_t> voxelsOfClass;
  /** Of all known voxels, meters, map frame; empty for an empty map. */
  Eigen::AlignedBox3d box;
};

/** Counts; takes one look at each leaf. */
MapContents contentsOf(const SemanticOcTree& tree);

}  // namespace semantic_octree
