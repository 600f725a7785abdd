#include "SimulatedRobot.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace simulated_drive {

using mrpt::math::TPose2D;

void PoseOptions::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("odometry_noise", odometryNoise, "m", between(0, 1),
           "standard deviation of the way after a meter; grows with its square root");
  list.add("turn_noise", turnNoise, "degrees", between(0, 90),
           "of the heading after a meter; grows alike");
}

void PoseOptions::validate() const { strict_files::checkOptions(*this, "PoseOptions"); }

SimulatedOdometry::SimulatedOdometry(const TPose2D& start, const PoseOptions& options,
                                     std::uint64_t seed)
    : m_options(options), m_pose(start), m_noise(synthetic_world::Random::ofStream(seed, 1, 0)) {
  m_options.validate();
}

void SimulatedOdometry::move(const TPose2D& motion) {
  constexpr double kDegree = M_PI / 180;
  const double root = std::sqrt(std::hypot(motion.x, motion.y));
  TPose2D measured = motion;
  measured.x += m_options.odometryNoise * root * m_noise.normal();
  measured.phi += m_options.turnNoise * kDegree * root * m_noise.normal();
  m_pose = m_pose + measured;
}

using semantic_driving::DriveCommand;

namespace {

/** From one value towards another, by at most this much. */
double towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

SimulatedRobot::SimulatedRobot(const mrpt::math::TPose2D& start,
                               const semantic_driving::DriveOptions& limits)
    : m_limits(limits) {
  m_state.pose = start;
}

void SimulatedRobot::drive(const DriveCommand& command, double seconds) {
  constexpr int kSteps = 10;
  for (int i = 0; i < kSteps; ++i) step(command, seconds / kSteps);
}

void SimulatedRobot::step(const DriveCommand& command, double seconds) {
  constexpr double kTurnAcceleration = 4;  // rad/s^2, of the steering
  const double wanted = std::clamp(command.speed, -m_limits.maxSpeed, m_limits.maxSpeed);
  m_state.speed = towards(m_state.speed, wanted, m_limits.maxAcceleration * seconds);
  // The command's curve, not its turning: a car that is not up to its speed steers as if it were.
  const double curvature = std::abs(command.speed) > 1e-6 ? command.turn / command.speed : 0;
  const double most = std::abs(m_state.speed) / m_limits.turningRadius;
  const double turn = std::clamp(curvature * m_state.speed, -most, most);
  m_state.turn = std::clamp(towards(m_state.turn, turn, kTurnAcceleration * seconds), -most, most);
  const double heading = m_state.pose.phi + m_state.turn * seconds / 2;
  m_state.pose.x += m_state.speed * seconds * std::cos(heading);
  m_state.pose.y += m_state.speed * seconds * std::sin(heading);
  m_state.pose.phi = mrpt::math::wrapToPi(m_state.pose.phi + m_state.turn * seconds);
}

}  // namespace simulated_drive
