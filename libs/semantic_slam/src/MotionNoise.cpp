#include "MotionNoise.h"
#include "SensorScale.h"

#include <algorithm>
#include <cmath>

namespace semantic_slam {
namespace {

/** The last steps count, as many as these. */
constexpr double kRemembered = 50;
/** Squared factors stay above, and one step's part below: a slip is no law. */
constexpr double kLeast = 0.01, kMost = 25;

double measured(double factor, double squared) {
  return std::max(kLeast, factor + (std::min(squared, kMost) - factor) / kRemembered);
}

}  // namespace

auto MotionNoise::deviationsOf(const Eigen::Isometry3d& T_step) const -> Deviations {
  if (m_isConstantVelocity) return {0.5, 5 * kDegree};
  const double root = std::sqrt(T_step.translation().norm()),
               turned = vectorOf(T_step).tail<3>().norm();
  return {0.01 + 0.1 * root, (0.1 + 2 * root) * kDegree + 0.5 * turned};  // bad wheels
}

Matrix6 MotionNoise::information(const Eigen::Isometry3d& T_step) const {
  const Deviations first = deviationsOf(T_step);
  return informationOf(wayFactor() * first.way, turnFactor() * first.turn);
}

void MotionNoise::note(const Eigen::Isometry3d& T_step, const Eigen::Isometry3d& T_off,
                       const Matrix6& information) {
  const Deviations first = deviationsOf(T_step);
  const Vector6 off = vectorOf(T_off);
  const Matrix6 covariance = information.inverse();
  m_way = measured(m_way, (off.head<2>().squaredNorm() + covariance(0, 0) + covariance(1, 1)) /
                              (2 * first.way * first.way));
  m_turn = measured(m_turn, (off[5] * off[5] + covariance(5, 5)) / (first.turn * first.turn));
}

}  // namespace semantic_slam
