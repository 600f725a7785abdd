#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

// Uses these three without including them.
#include <octomap/OcTreeKey.h>

/** \file
 * Keys: OctoMap's numbers of the voxels along an axis, 0 to 65535. They are whole numbers of
 * type int here, because differences and neighbors may lie outside. */

namespace semantic_octree {

/** Depth of a voxel; the root's is 0. */
constexpr int kTreeDepth = 16;
constexpr int kNumKeys = 1 << kTreeDepth;
/** Key of the voxel whose lowest corner is at coordinate 0: as many voxels are on each side. */
constexpr int kKeyOfOrigin = kNumKeys / 2;

/** Edge, in voxels, of the cube that a node at a depth stands for. */
constexpr int edgeAtDepth(int depth) { return 1 << (kTreeDepth - depth); }
/** Lowest key of the cube at a depth that a voxel is in. */
constexpr int lowestKeyAtDepth(int key, int depth) { return key & ~(edgeAtDepth(depth) - 1); }

/** The whole number at or below x. (std::floor is a function call on processors of the common
 * denominator.) */
inline int floorOf(double x) {
  const int towardsZero = static_cast<int>(x);
  return towardsZero - (x < towardsZero);
}

/** A coordinate (meters, map frame) in voxels. It is multiplied by the reciprocal, as in OctoMap,
 * so that what lies on a border has OctoMap's key (0.3 / 0.1 < 3). */
inline double inVoxels(double coordinate, double voxelSize) { return coordinate * (1 / voxelSize); }
/** Key of the voxel that holds a coordinate (meters, map frame); beyond 0..65535 for one outside of
 * the map. */
inline int keyOf(double coordinate, double voxelSize) {
  return floorOf(inVoxels(coordinate, voxelSize)) + kKeyOfOrigin;
}
/** Coordinate (meters, map frame) of a voxel's lower border. */
inline double lowerBorderOf(int key, double voxelSize) { return (key - kKeyOfOrigin) * voxelSize; }
/** Coordinate (meters, map frame) of a voxel's center. */
inline double centerOf(int key, double voxelSize) { return (key - kKeyOfOrigin + 0.5) * voxelSize; }
/** The center of the cube at a depth that a voxel is in, m. */
inline double centerOf(int key, double voxelSize, int depth) {
  return (lowestKeyAtDepth(key, depth) - kKeyOfOrigin + 0.5 * edgeAtDepth(depth)) * voxelSize;
}

/** Three keys as OctoMap has them. Each must be 0 to 65535. */
inline octomap::OcTreeKey octomapKey(int x, int y, int z) {
  return octomap::OcTreeKey(static_cast<octomap::key_type>(x), static_cast<octomap::key_type>(y),
                            static_cast<octomap::key_type>(z));
}

}  // namespace semantic_octree
