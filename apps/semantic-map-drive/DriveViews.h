#pragma once
#include <map_pictures/MapCanvas.h>
#include <semantic_octree/MapFollower.h>

#include <chrono>
#include <optional>

#include "map_window/LiveMap.h"
#include "simulated_drive/DriveLoop.h"

namespace semantic_map_drive {

using namespace simulated_drive;

/** Colors of pictures and of the window. */
constexpr semantic_types::Color kPathColor{220, 40, 40}, kGoalColor{200, 30, 30},
    kRobotColor{20, 120, 230}, kLeftColor{225, 30, 160};
/** What is that far above the ground is not shown: crowns of trees would hide the way. m */
constexpr double kCutAbove = 2.5;

/** Seconds, meters, speed, and where to. */
std::string caption(const DriveLoop& loop);
Eigen::AlignedBox2d around(const mrpt::math::TPose2D& pose, double meters);

/** The drive from above: the map in its classes' colors, start and goal, the rest of the path, the
 * driven track, the robot. One picture is like the other in place and size. */
class DrivePicture {
 public:
  /** \param region of the world, m \param longerEdge of it, at least so many pixels
   * \param showsLeft shades over the map say what looking may still tell */
  DrivePicture(const Eigen::AlignedBox2d& region, int longerEdge, bool showsLeft)
      : m_region(region), m_longerEdge(longerEdge), m_showsLeft(showsLeft) {}
  /** Makes room for a drive's track, too. */
  void include(const DriveRecord& record);

  map_pictures::MapCanvas draw(DriveLoop& loop) const;
  /** The picture with title, scale and legend, all in places that stay from frame to frame. Only
   * what changed in the map since the last one is drawn anew; of what is left to see, what is near
   * that. */
  cv::Mat frame(DriveLoop& loop);

 private:
  map_pictures::MapCanvas drawMap(const Eigen::AlignedBox2d& part, DriveLoop& loop) const;
  void follow(DriveLoop& loop);

  Eigen::AlignedBox2d m_region;  ///< m
  int m_longerEdge;
  bool m_showsLeft;
  std::optional<semantic_octree::MapFollower> m_changes;
  std::optional<map_pictures::MapCanvas> m_map;  ///< as the last frame shows it
};

/** Shows a drive in the viewer's window while it goes on: the map, goal, path, driven track and
 * robot. The drive waits for the clock on the wall, until the window is closed. */
class LiveWindow : public DriveObserver {
 public:
  /** Opens the window on a map that the drive makes. \throw std::runtime_error there is no display.
   */
  LiveWindow(const DriveLoop& loop, const synthetic_world::World& world,
             const mrpt::math::TPose2D& start, const mrpt::math::TPose2D& goal);

  void stopWhen(const std::function<bool()>& isToEnd) { m_window->stopWhen(isToEnd); }
  /** Until the window is closed. */
  void stay() { m_window->stay(); }
  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override;
  void onDriven(const DriveLoop& loop) override;

 private:
  mrpt::math::TPoint3D m_goal;
  std::unique_ptr<map_window::LiveMap> m_window;
  std::chrono::steady_clock::time_point m_due;
};

}  // namespace semantic_map_drive
