#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_driving/DriveOptions.h>
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

/** The true motion of a car-like robot: commands are followed as fast as it can. */
class SimulatedRobot {
 public:
  SimulatedRobot(const mrpt::math::TPose2D& start, const semantic_driving::DriveOptions& limits);

  const semantic_driving::DriveState& state() const { return m_state; }
  /** \param seconds until the next command */
  void drive(const semantic_driving::DriveCommand& command, double seconds);

 private:
  void step(const semantic_driving::DriveCommand& command, double seconds);

  semantic_driving::DriveOptions m_limits;
  semantic_driving::DriveState m_state;
};

}  // namespace simulated_drive
