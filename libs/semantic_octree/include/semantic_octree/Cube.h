#pragma once
#include <semantic_octree/Keys.h>

#include <Eigen/Core>

namespace semantic_octree {

/** A cube of the octree: what a node at a depth stands for. */
struct Cube {
  Eigen::Array3i lowest{0, 0, 0};  ///< keys of its lowest voxel
  int depth = 0;

  /** The cube at a depth that holds a voxel. */
  static Cube around(const Eigen::Array3i& key, int depth) {
    return {key.unaryExpr([depth](int k) { return lowestKeyAtDepth(k, depth); }), depth};
  }
  /** Edge, in voxels. */
  int edge() const { return edgeAtDepth(depth); }
  /** i-th of the eight children in OctoMap's order: x is bit 0, y bit 1, z bit 2. */
  Cube child(int i) const {
    return {lowest + Eigen::Array3i(i & 1, i >> 1 & 1, i >> 2) * (edge() / 2), depth + 1};
  }
  /** Which child holds a voxel of the cube. */
  int childAt(const Eigen::Array3i& key) const {
    const Eigen::Array3i upper = (key >= lowest + edge() / 2).cast<int>();
    return upper.x() | upper.y() << 1 | upper.z() << 2;
  }
  bool contains(const Eigen::Array3i& key) const {
    return (key >= lowest).all() && (key < lowest + edge()).all();
  }
  /** Key as OctoMap's iterators give it: of the voxel just above its center. */
  octomap::OcTreeKey key() const {
    const Eigen::Array3i k = lowest + edge() / 2;
    return octomapKey(k.x(), k.y(), k.z());
  }
  /** m, map frame. */
  Eigen::Vector3d center(double voxelSize) const {
    const auto along = [&](int key) { return centerOf(key, voxelSize, depth); };
    return {along(lowest.x()), along(lowest.y()), along(lowest.z())};
  }
  bool operator==(const Cube& o) const { return depth == o.depth && (lowest == o.lowest).all(); }
};

}  // namespace semantic_octree
