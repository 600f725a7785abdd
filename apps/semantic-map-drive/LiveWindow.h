#pragma once
#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <chrono>

#include "simulated_drive/DriveLoop.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** Shows a drive in MRPT's window while it goes on: the map in its classes' colors, goal, path,
 * driven track and robot. The drive waits for the clock on the wall, until the window is closed. */
class LiveWindow : public DriveObserver {
 public:
  /** Opens the window. \throw std::runtime_error there is no display. */
  LiveWindow(const synthetic_world::World& world, const mrpt::math::TPose2D& start,
             const mrpt::math::TPose2D& goal);

  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override;
  void onDriven(const DriveLoop& loop) override;

 private:
  void pace(double period);

  mrpt::gui::CDisplayWindow3D::Ptr m_window;
  mrpt::opengl::CSetOfObjects::Ptr m_map = mrpt::opengl::CSetOfObjects::Create(),
                                   m_drive = mrpt::opengl::CSetOfObjects::Create();
  std::chrono::steady_clock::time_point m_due;
  double m_nextMap = 0;  ///< s of the drive
};

}  // namespace semantic_map_drive
