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

}  // namespace semantic_map_evaluate
