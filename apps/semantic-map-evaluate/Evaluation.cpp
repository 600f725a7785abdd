#include "Evaluation.h"

#include <algorithm>
#include <cmath>

namespace semantic_map_evaluate {

using semantic_octree::CellState;
using semantic_octree::ClassId;
using semantic_octree::kNoClass;

void Evaluation::ask(const semantic_octree::SmoothedView& view, const Eigen::Vector3d& point,
                     ClassId truth) {
  const CellState state = view.query(point.x(), point.y(), point.z());
  Answer answer{state.status == CellState::Status::Occupied, state.likeliestClass};
  if (answer.isOccupied && answer.likeliest != kNoClass) {
    const std::vector<double> p = view.distribution(point.x(), point.y(), point.z());
    answer.ofLikeliest = p[answer.likeliest] / (1 - p[0]);
    answer.ofTruth = p[truth] / (1 - p[0]);
  }
  add(answer, truth);
}

void Evaluation::add(const Answer& answer, ClassId truth) {
  const bool right = answer.likeliest == truth;
  ++m_points;
  m_right += right;
  m_occupied += answer.isOccupied;
  if (!answer.isOccupied || answer.likeliest == kNoClass) return;
  m_logLoss -= std::log(answer.ofTruth);
  const auto bin = static_cast<std::size_t>(answer.ofLikeliest * kBins);
  for (Bin* b : {&m_answered, &m_ofClass[truth], &m_bins[std::min(bin, kBins - 1)]}) {
    ++b->points;
    b->right += right;
    b->stated += answer.ofLikeliest;
  }
}

double Evaluation::meanRecall() const {
  double sum = 0;
  std::size_t classes = 0;
  for (const Bin& bin : m_ofClass)
    if (bin.points > 0) sum += bin.shareRight(), ++classes;
  return sum / static_cast<double>(classes);
}

double Evaluation::calibrationError() const {
  double sum = 0;
  for (const Bin& bin : m_bins) sum += std::fabs(bin.stated - static_cast<double>(bin.right));
  return sum / static_cast<double>(m_answered.points);
}

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
