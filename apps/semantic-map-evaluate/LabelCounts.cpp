#include "LabelCounts.h"

#include <algorithm>

namespace semantic_map_evaluate {

using semantic_octree::ClassId;
using semantic_octree::kNoClass;
namespace {

/** Labels that are nearly always right: one alone states 0.91. */
constexpr double kPriorLabels = 0.1;

}  // namespace

double& LabelCounts::countOf(Counts& counts, ClassId id) {
  const auto found =
      std::find_if(counts.begin(), counts.end(), [id](const auto& c) { return c.first == id; });
  return found != counts.end() ? found->second : counts.emplace_back(id, 0.0).second;
}

void LabelCounts::add(const semantic_types::LabeledCloud& cloud,
                      const Eigen::Isometry3d& T_map_sensor) {
  Voxels scan;
  for (std::size_t i = 0; i < cloud.classes.size(); ++i) {
    const Eigen::Vector3d p = T_map_sensor * cloud.points[i].cast<double>();
    octomap::OcTreeKey key;
    if (cloud.classes[i] == kNoClass || !m_map.coordToKeyChecked(p.x(), p.y(), p.z(), key))
      continue;
    ++countOf(scan[key], cloud.classes[i]);
  }
  for (const auto& [key, labels] : scan) {
    double all = 0;
    for (const auto& [id, count] : labels) all += count;
    Counts& counts = m_voxels[key];
    for (const auto& [id, count] : labels)
      countOf(counts, id) += m_counted == Counted::Labels ? count : count / all;
  }
}

Evaluation::Answer LabelCounts::answer(const Eigen::Vector3d& point, ClassId truth) const {
  octomap::OcTreeKey key;
  if (!m_map.coordToKeyChecked(point.x(), point.y(), point.z(), key)) return {};
  const auto found = m_voxels.find(key);
  if (found == m_voxels.end()) return {};
  const double prior = kPriorLabels / m_map.numClasses();
  double all = kPriorLabels, most = 0, ofTruth = 0;
  ClassId likeliest = kNoClass;
  for (const auto& [id, count] : found->second) {
    all += count;
    if (id == truth) ofTruth = count;
    if (count < most || (count == most && id > likeliest)) continue;
    most = count;
    likeliest = id;
  }
  return {true, likeliest, (most + prior) / all, (ofTruth + prior) / all};
}

}  // namespace semantic_map_evaluate
