#pragma once
#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>
#include <synthetic_world/Objects.h>

#include <cstdint>

namespace simulated_drive {

/** How the robot knows its pose. Without noise it knows it exactly. */
struct PoseOptions {
  /** Standard deviation of the way that odometry reports, meters after one meter; it grows with the
   * square root of the way. */
  double odometryNoise = 0;
  double turnNoise = 0;  ///< of the heading, degrees after one meter; grows alike

  void describe(strict_files::OptionList& list);
  bool isExact() const { return odometryNoise == 0 && turnNoise == 0; }
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Where wheels with noise say that the robot is. */
class SimulatedOdometry {
 public:
  /** \param seed of the noise */
  SimulatedOdometry(const mrpt::math::TPose2D& start, const PoseOptions& options,
                    std::uint64_t seed);

  /** \param motion true motion since the last call, in the robot's frame before it */
  void move(const mrpt::math::TPose2D& motion);
  const mrpt::math::TPose2D& pose() const { return m_pose; }

 private:
  PoseOptions m_options;
  mrpt::math::TPose2D m_pose;
  synthetic_world::Random m_noise;
};

}  // namespace simulated_drive
