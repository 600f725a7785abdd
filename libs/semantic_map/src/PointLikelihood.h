#pragma once
#include <semantic_octree/SemanticOcTree.h>

namespace semantic_map {

/** Likelihood that a return ends at a place of the map, by the sensor model of the map's filter.
 *
 * With S the state of the cell (free, or one of K classes),
 *
 *     p(return, label c | cell) = p(S = free) p_fa + p_hit sum_k p(S = k) K P(label c | k),
 *
 * where P(label c | k) is the accuracy for c = k and the rest of it shared by the others. The
 * factor K makes a label that says nothing equal to none. Without a label the sum is p(occupied).
 * Unknown space is as likely free as occupied, by any class. */
class PointLikelihood {
 public:
  explicit PointLikelihood(const semantic_octree::SemanticOcTree& tree);

  /** \param point map frame, m */
  double operator()(const Eigen::Vector3d& point) const;
  double operator()(const Eigen::Vector3d& point, semantic_octree::ClassId label) const;
  /** \param label K probabilities; all zero: no label */
  double operator()(const Eigen::Vector3d& point, const float* label) const;

 private:
  /** Probabilities of free space and of one class. */
  struct Cell {
    double free, ofClass;
  };
  Cell cell(const semantic_octree::SemanticOcTree::Node* node, semantic_octree::ClassId id) const;
  const semantic_octree::SemanticOcTree::Node* find(const Eigen::Vector3d& point) const;
  double labeled(const Cell& cell) const;
  double unlabeled(double free) const { return free * m_falseAlarm + (1 - free) * m_hit; }

  const semantic_octree::SemanticOcTree& m_tree;
  double m_hit, m_falseAlarm, m_accuracy;
};

}  // namespace semantic_map
