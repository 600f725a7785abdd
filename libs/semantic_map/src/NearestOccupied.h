#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <optional>

namespace semantic_map {

/** Finds the occupied voxel whose center is nearest to a point: a descent of the tree that leaves
 * out what is free and what is too far. */
class NearestOccupied {
 public:
  enum class Distance { InSpace, FromAbove };

  struct Voxel {
    Eigen::Vector3d center;  ///< m
    double squaredDistance;  ///< m^2
  };

  /** \param distance FromAbove: heights do not count */
  NearestOccupied(const semantic_octree::SemanticOcTree& tree, Distance distance);

  /** Nothing if all are at this distance (m) or farther. */
  std::optional<Voxel> operator()(const Eigen::Vector3d& point, double within) const;

 private:
  /** A node of the tree and its cube. */
  struct Cube {
    semantic_octree::SemanticOcTreeNode node;
    Eigen::Vector3d low;  ///< corner, m
    double size;          ///< edge, m
  };
  Voxel nearestIn(const Cube& cube, const Eigen::Vector3d& point) const;
  void descend(const Cube& cube, const Eigen::Vector3d& point, double& bound,
               std::optional<Voxel>& best) const;

  const semantic_octree::SemanticOcTree& m_tree;
  Eigen::Vector3d m_weights;
};

}  // namespace semantic_map
