#pragma once
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <Eigen/Core>

namespace semantic_octree {

using Node = SemanticOcTreeNode;

/** Voxel coordinates: key minus kKeyOfOrigin (floor(coordinate / resolution)), or keys. */
using VoxelIndex = Eigen::Array3i;

/** Cube of space that a node at some depth stands for; index = lowest key >> (16 - depth). */
struct Cell {
  VoxelIndex index = VoxelIndex::Zero();
  int depth = 0;

  bool operator==(const Cell& o) const { return depth == o.depth && (index == o.index).all(); }
  /** i-th of the eight children in OctoMap's order: x is bit 0, y bit 1, z bit 2. */
  Cell child(int i) const { return {index * 2 + VoxelIndex(i & 1, i >> 1 & 1, i >> 2), depth + 1}; }
  /** Which child, of its ancestor above, the ancestor at a depth is. */
  int childOnTheWay(int ancestor) const {
    const int shift = depth - ancestor;
    return (index.x() >> shift & 1) | (index.y() >> shift & 1) << 1 | (index.z() >> shift & 1) << 2;
  }
  /** Edge in voxels. */
  int edge() const { return edgeAtDepth(depth); }
  /** Lowest voxel, as a key. */
  VoxelIndex lowest() const { return index * edge(); }
  Cube cube() const { return {lowest(), depth}; }
  /** Key as OctoMap's iterators give it: of the voxel just above the cell's center. */
  octomap::OcTreeKey key() const { return cube().key(); }
};

}  // namespace semantic_octree
