#pragma once
#include <semantic_octree/SemanticOcTree.h>

namespace semantic_map {

/** Likelihood that a return ends at a place of the map, or that a beam passes through it, by the
 * sensor model of the map's filter; see TLikelihoodOptions for the equations. */
class PointLikelihood {
 public:
  explicit PointLikelihood(const semantic_octree::SemanticOcTree& tree);

  /** \param point map frame, m */
  double operator()(const Eigen::Vector3d& point) const;
  double operator()(const Eigen::Vector3d& point, semantic_types::ClassId label) const;
  /** \param label K probabilities; all zero: no label */
  double operator()(const Eigen::Vector3d& point, const float* label) const;
  /** Likelihood that the beam passes. */
  double passing(const Eigen::Vector3d& point) const;

 private:
  /** Probabilities of free space and of one class. */
  struct Cell {
    double free, ofClass;
  };
  Cell cell(const semantic_octree::SemanticOcTreeNode& node, semantic_types::ClassId id) const;
  semantic_octree::SemanticOcTreeNode find(const Eigen::Vector3d& point) const;
  double labeled(const Cell& cell) const;
  double occupancy(const Eigen::Vector3d& point) const;
  double unlabeled(double occupancy) const {
    return m_falseAlarm + occupancy * (m_hit - m_falseAlarm);
  }

  const semantic_octree::SemanticOcTree& m_tree;
  double m_hit, m_falseAlarm, m_accuracy;
};

}  // namespace semantic_map
