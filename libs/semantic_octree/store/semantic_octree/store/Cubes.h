#pragma once
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <Eigen/Core>
#include <cstdint>

namespace semantic_octree {

using Node = SemanticOcTreeNode;

/** Voxel coordinates: key minus kKeyOfOrigin (floor(coordinate / resolution)), or keys. */
using VoxelIndex = Eigen::Array3i;

/** A cube's place among those of its depth. */
inline VoxelIndex indexOf(const Cube& cube) {
  const int shift = kTreeDepth - cube.depth;
  return {cube.lowest.x() >> shift, cube.lowest.y() >> shift, cube.lowest.z() >> shift};
}
inline Cube cubeAt(const VoxelIndex& index, int depth) {
  return {index * edgeAtDepth(depth), depth};
}
/** Which child of its parent the cube's ancestor at a depth from 1 on is. */
inline int childOnTheWay(const Cube& cube, int depth) {
  const int bit = kTreeDepth - depth;
  return (cube.lowest.x() >> bit & 1) | (cube.lowest.y() >> bit & 1) << 1 |
         (cube.lowest.z() >> bit & 1) << 2;
}

/** A cube as a number below 2^53: depth, z, y, x. */
inline std::uint64_t packed(const Cube& cube) {
  const auto bits = [](int number, int at) { return static_cast<std::uint64_t>(number) << at; };
  return bits(cube.depth, 48) | bits(cube.lowest.z(), 32) | bits(cube.lowest.y(), 16) |
         bits(cube.lowest.x(), 0);
}
inline Cube unpacked(std::uint64_t cube) {
  const auto number = [cube](int at) { return static_cast<int>(cube >> at & 0xffff); };
  return {{number(0), number(16), number(32)}, number(48)};
}

}  // namespace semantic_octree
