#pragma once
#include <semantic_driving/DriveOptions.h>

namespace simulated_drive {

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
