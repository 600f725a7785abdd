#include <semantic_octree/LabelReliability.h>

#include <algorithm>
#include <cmath>

namespace semantic_octree {

using semantic_types::ClassId;
namespace {

constexpr double kStep = 1.0 / 64;
/** Where a border crosses a cell, right labels disagree, and more of them say no more. Without any
 * correlation, cells would be too sure. */
constexpr double kLeastCorrelation = 0.02;
/** Labels that agree as the parameters say, before any are seen. */
constexpr double kPriorLabels = 1000;

}  // namespace

void LabelAgreement::add(const ClassId* begin, const ClassId* end) {
  const auto n = static_cast<double>(end - begin);
  if (n < 2) return;
  double pairs = 0;
  while (begin != end) {
    const ClassId* const next = std::upper_bound(begin, end, *begin);
    const auto same = static_cast<double>(next - begin);
    pairs += same * (same - 1);
    begin = next;
  }
  m_labels += n;
  m_agreeing += pairs / (n - 1);
}

LabelReliability LabelAgreement::explain(const FilterParameters& p, int numClasses) const {
  const LabelReliability most{p.accuracy, p.labelCorrelation};
  if (numClasses == 1) return most;
  const double K = numClasses, wrong = 1 - p.accuracy;
  const double independent = p.accuracy * p.accuracy + wrong * wrong / (K - 1);
  const double expected = independent + p.labelCorrelation * (1 - independent);
  const double seen = (m_agreeing + kPriorLabels * expected) / (m_labels + kPriorLabels);
  if (seen > expected - kStep) return most;
  const double agreement = std::round(seen / kStep) * kStep;
  const double least = std::min(kLeastCorrelation, p.labelCorrelation);
  const double correlation = (agreement - independent) / (1 - independent);
  if (correlation >= least) return {p.accuracy, correlation};
  // Solved for the accuracy; labels that agree by chance alone still say a little.
  const double ofIndependent = std::max((agreement - least) / (1 - least), 1 / K + kStep);
  const double accuracy = (1 + std::sqrt((K - 1) * (K * ofIndependent - 1))) / K;
  return {std::min(p.accuracy, accuracy), least};
}

}  // namespace semantic_octree
