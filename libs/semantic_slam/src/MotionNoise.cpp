#include "MotionNoise.h"
#include "SensorScale.h"

#include <algorithm>
#include <cmath>

namespace semantic_slam {
namespace {

/** The last steps count, as many as these. */
constexpr double kRemembered = 50;
/** What is assumed at first counts as so many. */
constexpr double kAssumed = 5;
/** Squared factors stay above, and one step's part below: a slip is no law. */
constexpr double kLeast = 0.01, kMost = 25;

/** What wheels do wrong at each step is learnt from stretches of so many m, and lasts for so many
 * of these. */
constexpr double kStretch = 2, kLasting = 100;
/** Standard deviations of what is known of it before: of the way and of turns, shares; of a robot
 * that goes straight, radians per m. */
constexpr double kFactorOfWay = 0.2, kFactorOfTurn = 0.3, kTurnPerMeter = 0.5 * kDegree;
/** Turns of fewer standard deviations are noise. */
constexpr double kTurned = 3;

double squared(double x) { return x * x; }

double measured(double factor, double squared, double remembered) {
  return std::max(kLeast, factor + (std::min(squared, kMost) - factor) / remembered);
}

}  // namespace

MotionNoise::MotionNoise(bool isConstantVelocity, double factor)
    : m_isConstantVelocity(isConstantVelocity), m_way(factor * factor), m_turn(factor * factor) {
  m_wayFactors.values << 1;
  m_wayFactors.information << 1 / squared(kFactorOfWay);
  m_turnFactors.values << 1, 0;
  m_turnFactors.information =
      Eigen::Vector2d(1 / squared(kFactorOfTurn), 1 / squared(kTurnPerMeter)).asDiagonal();
}

Eigen::Isometry3d MotionNoise::calibrated(const Eigen::Isometry3d& T_odometry_step) const {
  if (m_isConstantVelocity) return T_odometry_step;
  Vector6 v = vectorOf(T_odometry_step);
  const double way = v.head<3>().norm();
  v.head<3>() *= m_wayFactors.values[0];
  v[5] = m_turnFactors.values.dot(Eigen::Vector2d(v[5], way));
  return poseOf(v);
}

template <int kSize>
void MotionNoise::Factors<kSize>::learn(const Eigen::Matrix<double, kSize, 1>& said,
                                        const Stretch& s, int of) {
  const double variance = s.variance[of], most = std::sqrt(kMost * variance);
  information *= 1 - 1 / kLasting;
  information += s.share[of] / squared(variance) * said * said.transpose();
  values += information.ldlt().solve(said) * std::clamp(s.off[of], -most, most) / variance;
}

void MotionNoise::calibrate(const Eigen::Isometry3d& T_odometry_step,
                            const Eigen::Isometry3d& T_step, const Eigen::Isometry3d& T_off,
                            const Matrix6& information) {
  const Vector6 said = vectorOf(T_odometry_step), off = vectorOf(T_off);
  const double way = said.head<3>().norm();
  if (m_isConstantVelocity || way == 0) return;
  const Eigen::Vector3d ahead = T_step.linear().transpose() * said.head<3>() / way;
  const Matrix6 predicted = this->information(T_step), covariance = information.inverse();
  Stretch& s = m_stretch;
  s.way += way;
  s.turn += said[5];
  s.off += Eigen::Array2d(ahead.dot(off.head<3>()), off[5]);
  for (const int of : {0, 1}) {
    const double variance = 1 / predicted(5 * of, 5 * of);
    s.variance[of] += variance;
    s.share[of] += std::max(0., variance - covariance(5 * of, 5 * of));
  }
  if (s.way < kStretch) return;
  const bool turned = s.turn * s.turn > kTurned * kTurned * s.variance[1];
  m_wayFactors.learn(Eigen::Matrix<double, 1, 1>(s.way), s, 0);
  m_turnFactors.learn(Eigen::Vector2d(turned ? s.turn : 0, s.way), s, 1);
  s = {};
}

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
  // The harmonic mean of what scans tell of both directions: walls beside the robot tell nothing of
  // the way along them, and so little of the whole.
  const Matrix6 predicted = this->information(T_step);
  const auto toldOf = [&](int axis) {
    return std::clamp(1 - covariance(axis, axis) * predicted(axis, axis), 1e-3, 1.);
  };
  const double told = 2 / (1 / toldOf(0) + 1 / toldOf(1));
  m_numSteps = std::min(m_numSteps + 1, kRemembered - kAssumed);
  m_toldSteps = std::min(m_toldSteps + told, kRemembered - kAssumed);
  const double remembered = kAssumed + m_numSteps;
  m_way = measured(m_way,
                   (off.head<2>().squaredNorm() + covariance(0, 0) + covariance(1, 1)) /
                       (2 * first.way * first.way),
                   (kAssumed + m_toldSteps) / told);
  m_turn = measured(m_turn, (off[5] * off[5] + covariance(5, 5)) / (first.turn * first.turn),
                    remembered);
}

}  // namespace semantic_slam
