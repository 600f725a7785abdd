#include "PointLikelihood.h"

#include <cmath>

namespace semantic_map {

using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::kNoClass;

PointLikelihood::PointLikelihood(const SemanticOcTree& tree)
    : m_tree(tree),
      m_hit(tree.filterParameters().hitProbability),
      m_falseAlarm(tree.filterParameters().falseAlarmProbability),
      m_accuracy(tree.numClasses() == 1 ? 1 : tree.filterParameters().accuracy) {}

semantic_octree::SemanticOcTreeNode PointLikelihood::find(const Eigen::Vector3d& point) const {
  octomap::OcTreeKey key;
  if (!m_tree.coordToKeyChecked(point.x(), point.y(), point.z(), key)) return {};
  return m_tree.search(key);
}

double PointLikelihood::occupancy(const Eigen::Vector3d& point) const {
  const auto node = find(point);
  return node ? node->getOccupancy() : 0.5;
}

PointLikelihood::Cell PointLikelihood::cell(const SemanticOcTree::Node& node, ClassId id) const {
  const int K = m_tree.numClasses();
  if (!node) return {0.5, 0.5 / K};
  const auto belief = m_tree.belief(node);
  const auto p = belief.probabilities(K);
  const int named = belief.indexOf(id);
  return {p.free, named < 0 ? p.rest : p.named[named]};
}

double PointLikelihood::labeled(const Cell& cell) const {
  const int K = m_tree.numClasses();
  const double ofOthers = 1 - cell.free - cell.ofClass;
  const double wrong = K == 1 ? 0 : (1 - m_accuracy) / (K - 1);
  return cell.free * m_falseAlarm + m_hit * K * (m_accuracy * cell.ofClass + wrong * ofOthers);
}

double PointLikelihood::operator()(const Eigen::Vector3d& point) const {
  return unlabeled(occupancy(point));
}

double PointLikelihood::passing(const Eigen::Vector3d& point) const {
  return 1 - unlabeled(occupancy(point));
}

double PointLikelihood::operator()(const Eigen::Vector3d& point, ClassId label) const {
  if (label == kNoClass) return (*this)(point);
  return labeled(cell(find(point), label));
}

double PointLikelihood::operator()(const Eigen::Vector3d& point, const float* label) const {
  const auto node = find(point);
  double sum = 0, total = 0;
  for (int k = 1; k <= m_tree.numClasses(); ++k) {
    if (label[k - 1] <= 0) continue;
    total += label[k - 1];
    sum += label[k - 1] * labeled(cell(node, static_cast<ClassId>(k)));
  }
  return total > 0 ? sum / total : unlabeled(occupancy(point));
}

}  // namespace semantic_map
