#pragma once
#include <chrono>

#include "map_window/LiveMap.h"
#include "simulated_drive/DriveLoop.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** Shows a drive in the viewer's window while it goes on: the map, goal, path, driven track and
 * robot. The drive waits for the clock on the wall, until the window is closed. */
class LiveWindow : public DriveObserver {
 public:
  /** Opens the window on a map that the drive makes. \throw std::runtime_error there is no display.
   */
  LiveWindow(const DriveLoop& loop, const synthetic_world::World& world,
             const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal);

  void stopWhen(const std::function<bool()>& isToEnd) { m_window.stopWhen(isToEnd); }
  /** Until the window is closed. */
  void stay() { m_window.stay(); }
  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override;
  void onDriven(const DriveLoop& loop) override;

 private:
  mrpt::math::TPoint3D m_goal;
  map_window::LiveMap m_window;
  std::chrono::steady_clock::time_point m_due;
};

}  // namespace semantic_map_drive
