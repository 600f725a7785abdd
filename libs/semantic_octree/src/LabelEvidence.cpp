#include <semantic_octree/LabelEvidence.h>

#include <algorithm>
#include <cmath>

namespace semantic_octree {
namespace {

/** Counts of labels whose evidence is kept. */
constexpr int kFew = 64;
/** At it hundreds of labels count one by one, and the digits suffice. */
constexpr double kNoCorrelation = 1e-9;

/** ln Gamma(x) less a constant, by Stirling's series: 1e-8 for x of 64 and more. */
double logGamma(double x) { return (x - 0.5) * std::log(x) - x + 1 / (12 * x); }

}  // namespace

LabelEvidence::LabelEvidence(double accuracy, int numClasses, double correlation) {
  const double s = 1 / std::max(correlation, kNoCorrelation) - 1;
  const double wrong = (1 - accuracy) / (numClasses - 1);
  m_right = s * accuracy;
  m_wrong = s * wrong;
  m_ofFew = {0, std::log(accuracy / wrong)};
  for (int i = 1; i < kFew; ++i)
    m_ofFew.push_back(m_ofFew.back() + std::log((m_right + i) / (m_wrong + i)));
  m_atMany = m_ofFew.back() - ofMany(kFew);
}

double LabelEvidence::ofMany(double n) const {
  return m_atMany + logGamma(m_right + n) - logGamma(m_wrong + n);
}

}  // namespace semantic_octree
