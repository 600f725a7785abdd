#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>
#include <numeric>

namespace semantic_octree {
namespace {

constexpr int kRounds = 60;
constexpr double kLeastPower = 1.0 / 64, kMostPower = 4, kMostShared = 0.9, kLargestStep = 0.1;
/** Cells that are as stated, of each class, before any are seen. */
constexpr double kStatedBefore = 100;

}  // namespace

void CalibrationFit::add(const ClassBelief& belief, const std::vector<double>& classes,
                         double weight) {
  const int unnamed = belief.unnamed(static_cast<int>(classes.size()));
  Question question{belief.count, unnamed, belief.ids, {}, {}, weight};
  const double most = std::max(belief.logOdds[0], belief.rest);
  question.ahead[3] = belief.rest - most;
  question.target[3] = 1;
  m_unnamed.resize(classes.size());
  for (std::size_t k = 0; k < classes.size(); ++k) m_unnamed[k] += weight * classes[k];
  for (int i = 0; i < belief.count; ++i) {
    question.ahead[i] = belief.logOdds[i] - most;
    question.target[i] = classes[belief.ids[i] - 1];
    question.target[3] -= question.target[i];
    m_unnamed[belief.ids[i] - 1] -= weight * question.target[i];
  }
  m_questions.push_back(question);
}

/** Sums over questions of what a step needs. */
struct CalibrationFit::Step {
  double slope = 0, curvature = 0, ofShared = 0, all = 0;
  // By classes, only with factors: what cells are, what is stated of cells that name the class, and
  // of the others per unit of the factor. `unnamed`: of all cells as if they named none.
  std::vector<double> is, stated, others;
  double unnamed = 0;

  /** Expectation: of each class that was named, which part is due to what is shared. The rest is a
   * power's, whose logarithm's slope and curvature follow. */
  void add(const Question& question, const Calibration& now, double sumOfFactors) {
    std::array<double, 4> odds{}, factors{};
    factors[3] = question.unnamed;
    if (!now.factors.empty()) factors[3] = sumOfFactors;
    double sum = 0, mean = 0, square = 0;
    for (int i = 0; i < question.named; ++i) {
      factors[i] = now.factors.empty() ? 1 : now.factors[question.ids[i] - 1];
      if (!now.factors.empty()) factors[3] -= factors[i];
    }
    const auto classes = [&](auto visit) {
      for (int i = 0; i < question.named; ++i) visit(i);
      visit(3);
    };
    classes([&](int i) {
      odds[i] = exactExponential(now.power * question.ahead[i]);
      sum += factors[i] * odds[i];
      mean += factors[i] * odds[i] * question.ahead[i];
      square += factors[i] * odds[i] * question.ahead[i] * question.ahead[i];
    });
    mean /= sum;
    double own = 0, target = 0;
    std::array<double, 4> ofPower{};
    classes([&](int i) {
      const double shared = i < 3 ? now.shared / question.named : 0;
      const double ofThis = (1 - now.shared) * factors[i] * odds[i] / sum + shared;
      const double share = shared > 0 ? shared / ofThis : 0;
      ofPower[i] = question.target[i] * (1 - share);
      own += ofPower[i];
      target += ofPower[i] * question.ahead[i];
    });
    slope += question.weight * (target - own * mean);
    curvature += question.weight * own * (square / sum - mean * mean);
    ofShared += question.weight * (1 - own);
    all += question.weight;
    if (now.factors.empty()) return;
    const double total = question.weight * own / sum;
    unnamed += total * odds[3];
    for (int i = 0; i < question.named; ++i) {
      const std::size_t k = question.ids[i] - std::size_t{1};
      is[k] += question.weight * ofPower[i];
      stated[k] += total * factors[i] * odds[i];
      others[k] -= total * odds[3];
    }
  }
  /** Maximization: one Newton step for the power. Factors are scaled by what cells are over what is
   * stated, with so many that are as stated beside (Darroch and Ratcliff, "Generalized Iterative
   * Scaling for Log-Linear Models", 1972). Their mean is 1. */
  Calibration after(const Calibration& now) const {
    const double step = curvature > 0 ? slope / curvature : 0;
    Calibration next{std::clamp(now.power + std::clamp(step, -kLargestStep, kLargestStep),
                                kLeastPower, kMostPower),
                     std::clamp(ofShared / all, 0.0, kMostShared), now.factors};
    double sum = 0;
    for (std::size_t k = 0; k < next.factors.size(); ++k) {
      double& factor = next.factors[k];
      const double told = stated[k] + factor * std::max(0.0, unnamed + others[k]);
      sum += factor *= (is[k] + kStatedBefore) / (told + kStatedBefore);
    }
    constexpr double kMost = Calibration::kMostFactor;
    for (double& factor : next.factors)
      factor =
          std::clamp(factor * static_cast<double>(next.factors.size()) / sum, 1 / kMost, kMost);
    return next;
  }
};

Calibration CalibrationFit::fit(Calibration calibration) const {
  for (int round = 0; round < kRounds; ++round) {
    Step step;
    const std::size_t K = calibration.factors.size();
    if (K > 0) step.is = m_unnamed, step.stated.resize(K), step.others.resize(K);
    const auto& factors = calibration.factors;
    const double sum = std::accumulate(factors.begin(), factors.end(), 0.0);
    for (const Question& question : m_questions) step.add(question, calibration, sum);
    calibration = step.after(calibration);
  }
  return calibration;
}

}  // namespace semantic_octree
