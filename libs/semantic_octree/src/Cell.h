#pragma once
#include <Eigen/Core>
#include <cstdint>

// Uses <cstdint> without including it.
#include <octomap/OcTreeKey.h>

namespace semantic_octree {

/** Voxel coordinates: key minus 32768 (floor(coordinate / resolution)), or keys. */
using VoxelIndex = Eigen::Array3i;

constexpr int kTreeDepth = 16;

/** Cube of space that a node at some depth stands for; index = lowest key >> (16 - depth). */
struct Cell {
  VoxelIndex index = VoxelIndex::Zero();
  int depth = 0;

  /** i-th of the eight children in OctoMap's order: x is bit 0, y bit 1, z bit 2. */
  Cell child(int i) const { return {index * 2 + VoxelIndex(i & 1, i >> 1 & 1, i >> 2), depth + 1}; }
  /** Edge in voxels. */
  int edge() const { return 1 << (kTreeDepth - depth); }
  /** Lowest voxel, as a key. */
  VoxelIndex lowest() const { return index * edge(); }
  /** Key as OctoMap's iterators give it: of the voxel just above the cell's center. */
  octomap::OcTreeKey key() const {
    const VoxelIndex k = lowest() + edge() / 2;
    return octomap::OcTreeKey(static_cast<octomap::key_type>(k.x()),
                              static_cast<octomap::key_type>(k.y()),
                              static_cast<octomap::key_type>(k.z()));
  }
};

}  // namespace semantic_octree
