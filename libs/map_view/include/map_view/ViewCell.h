#pragma once
#include <semantic_octree/Keys.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <Eigen/Core>
#include <cstdint>

namespace map_view {

/** A cube of a map as a view shows it. */
struct ViewCell {
  Eigen::Array3i lowest;  ///< keys of its lowest voxel
  int depth = 0;
  /** What it shows: the node for the cube or for a larger one around it; of a cube that stands for
   * finer cells, one of these, from its upper half if there is one; none: unknown space. */
  semantic_octree::SemanticOcTreeNode node;
  /** Tells inner nodes of the map apart; 0 for leaves. */
  std::uint64_t innerNode = 0;
  /** In a compressed tree, InformationTree's number of the inner node: the cube's, or the smallest
   * one around it. */
  std::int32_t around = 0;

  /** Edge, in voxels. */
  int edge() const { return semantic_octree::edgeAtDepth(depth); }
  bool isOccupied() const { return node && node.getLogOdds() > 0; }
  /** m, map frame. */
  Eigen::Vector3d center(double voxelSize) const {
    const auto along = [&](int key) { return semantic_octree::centerOf(key, voxelSize, depth); };
    return {along(lowest.x()), along(lowest.y()), along(lowest.z())};
  }
  octomap::OcTreeKey key() const {
    return semantic_octree::octomapKey(lowest.x(), lowest.y(), lowest.z());
  }
};

/** A box of voxels: keys, both ends included. */
struct KeyBox {
  Eigen::Array3i low, high;
  static KeyBox everything() {
    return {Eigen::Array3i::Zero(), Eigen::Array3i::Constant(semantic_octree::kNumKeys - 1)};
  }
  bool meets(const Eigen::Array3i& lowest, int edge) const {
    return (lowest <= high).all() && (lowest + edge > low).all();
  }
  bool contains(const Eigen::Array3i& lowest, int edge) const {
    return (lowest >= low).all() && (lowest + edge - 1 <= high).all();
  }
};

}  // namespace map_view
