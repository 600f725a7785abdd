#include "SimulatedOdometry.h"

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

}  // namespace simulated_drive
