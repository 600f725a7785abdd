#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>

namespace semantic_octree {
namespace {

constexpr int kRounds = 60;
constexpr double kLeastPower = 1.0 / 64, kMostPower = 4, kMostShared = 0.9, kLargestStep = 0.1;

}  // namespace

void CalibrationFit::add(const ClassBelief<float>& belief, const std::vector<double>& classes,
                         double weight) {
  const int unnamed = belief.unnamed(static_cast<int>(classes.size()));
  Question question{belief.count, unnamed, {}, {}, weight};
  const double most = std::max(belief.logOdds[0], belief.rest);
  question.ahead[3] = belief.rest - most;
  question.target[3] = 1;
  for (int i = 0; i < belief.count; ++i) {
    question.ahead[i] = belief.logOdds[i] - most;
    question.target[i] = classes[belief.ids[i] - 1];
    question.target[3] -= question.target[i];
  }
  m_questions.push_back(question);
}

/** Sums over questions of what a step needs. */
struct CalibrationFit::Step {
  double slope = 0, curvature = 0, ofShared = 0, all = 0;

  /** Expectation: of each class that was named, which part is due to what is shared. The rest is a
   * power's, whose logarithm's slope and curvature follow. */
  void add(const Question& question, const Calibration& now) {
    std::array<double, 4> odds{};
    double sum = 0, mean = 0, square = 0;
    const auto classes = [&](auto visit) {
      for (int i = 0; i < question.named; ++i) visit(i, 1);
      visit(3, question.unnamed);
    };
    classes([&](int i, int number) {
      odds[i] = exactExponential(now.power * question.ahead[i]);
      sum += number * odds[i];
      mean += number * odds[i] * question.ahead[i];
      square += number * odds[i] * question.ahead[i] * question.ahead[i];
    });
    mean /= sum;
    double own = 0, target = 0;
    classes([&](int i, int) {
      const double shared = i < 3 ? now.shared / question.named : 0;
      const double share = shared / ((1 - now.shared) * odds[i] / sum + shared);
      own += question.target[i] * (1 - share);
      target += question.target[i] * (1 - share) * question.ahead[i];
    });
    slope += question.weight * (target - own * mean);
    curvature += question.weight * own * (square / sum - mean * mean);
    ofShared += question.weight * (1 - own);
    all += question.weight;
  }
  /** Maximization, one step of Newton's for the power. */
  Calibration after(const Calibration& now) const {
    const double step = curvature > 0 ? slope / curvature : 0;
    return {std::clamp(now.power + std::clamp(step, -kLargestStep, kLargestStep), kLeastPower,
                       kMostPower),
            std::clamp(ofShared / all, 0.0, kMostShared)};
  }
};

Calibration CalibrationFit::fit(Calibration calibration) const {
  for (int round = 0; round < kRounds; ++round) {
    Step step;
    for (const Question& question : m_questions) step.add(question, calibration);
    calibration = step.after(calibration);
  }
  return calibration;
}

}  // namespace semantic_octree
