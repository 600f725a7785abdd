#pragma once
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <cstdint>

namespace map_view {

using semantic_octree::Cube;

/** A cube of a map as a view shows it. */
struct ViewCell : Cube {
  /** What it shows: the node for the cube or for a larger one around it; of a cube that stands for
   * finer cells, one of these, from its upper half if there is one; none: unknown space. */
  semantic_octree::SemanticOcTreeNode node;
  /** Tells inner nodes of the map apart; 0 for leaves. */
  std::uint64_t innerNode = 0;
  /** In a compressed tree, InformationTree's number of the inner node: the cube's, or the smallest
   * one around it. */
  std::int32_t around = 0;

  bool isOccupied() const { return node && node.getLogOdds() > 0; }
};

/** A box of voxels: keys, both ends included. */
struct KeyBox {
  Eigen::Array3i low, high;
  static KeyBox everything() {
    return {Eigen::Array3i::Zero(), Eigen::Array3i::Constant(semantic_octree::kNumKeys - 1)};
  }
  static KeyBox of(const Cube& cube) { return {cube.lowest, cube.lowest + (cube.edge() - 1)}; }
  bool meets(const Cube& cube) const {
    return (cube.lowest <= high).all() && (cube.lowest + cube.edge() > low).all();
  }
  bool contains(const Cube& cube) const {
    return (cube.lowest >= low).all() && (cube.lowest + cube.edge() - 1 <= high).all();
  }
};

}  // namespace map_view
