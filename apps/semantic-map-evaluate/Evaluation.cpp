#include "Evaluation.h"

#include <cmath>

namespace semantic_map_evaluate {

using semantic_octree::CellState;
using semantic_octree::ClassId;
using semantic_octree::kNoClass;

void Evaluation::ask(const semantic_octree::SmoothedView& view, const Eigen::Vector3d& point,
                     ClassId truth) {
  const CellState state = view.query(point.x(), point.y(), point.z());
  const bool right = state.likeliestClass == truth;
  ++m_points;
  m_right += right;
  if (state.status != CellState::Status::Occupied) return;
  ++m_occupied;
  if (state.likeliestClass == kNoClass) return;
  const std::vector<double> p = view.distribution(point.x(), point.y(), point.z());
  const double stated = p[state.likeliestClass] / (1 - p[0]);
  m_logLoss -= std::log(p[truth] / (1 - p[0]));
  const auto bin = static_cast<std::size_t>(stated * kBins);
  for (Bin* b : {&m_answered, &m_ofClass[truth], &m_bins[std::min(bin, kBins - 1)]}) {
    ++b->points;
    b->right += right;
    b->stated += stated;
  }
}

double Evaluation::calibrationError() const {
  double sum = 0;
  for (const Bin& bin : m_bins) sum += std::fabs(bin.stated - static_cast<double>(bin.right));
  return sum / static_cast<double>(m_answered.points);
}

}  // namespace semantic_map_evaluate
