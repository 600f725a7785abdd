#pragma once
#include <semantic_driving/DrivePath.h>
#include <semantic_driving/DynamicObstacles.h>
#include <semantic_driving/PathTracker.h>
#include <semantic_driving/ReactiveNavigator.h>

#include <functional>

namespace semantic_driving {

/** Drives a path: MRPT's reactive navigator around what stands in the way (forward, not to an exact
 * pose), else the tracker. Whatever either of them wants, the vehicle does not go where it could
 * not stop before an obstacle. It lets people pass (separationSpeed()), and steps aside where
 * somebody walks into it as it stands. Acceleration and steering change as fast as DriveOptions
 * say, at most. */
class DriveController {
 public:
  /** \throw std::exception bad options, or what the reactive navigator does not like. */
  DriveController(const DriveOptions& options, const ReactiveNavigator::Options& reactive);

  /** Follows this path from its beginning on, from now on. */
  void setPath(DrivePath path);
  /** See PathTracker. */
  void setClassSpeeds(std::vector<double> speeds) { m_tracker.setClassSpeeds(std::move(speeds)); }
  const PathTracker& tracker() const { return m_tracker; }
  /** Where the vehicle was at each step(). */
  const DrivenTrack& track() const { return m_track; }

  /** \param sensorAge seconds since the last observation \param seconds the time
   * \param movers where they are now, map frame \param room obstacles, and what is not known to be
   * ground (ObstacleOptions::unknown); null: it does not step aside */
  DriveCommand step(const DriveState& state, const ObstaclePoints& obstacles, double sensorAge,
                    double seconds, const DynamicObstacles& movers = {},
                    const ObstaclePoints* room = nullptr);

  /** Whether MRPT's navigator steers, and not the tracker. */
  bool isReactive() const { return m_isReactive; }
  /** Seconds since the vehicle last got on, although there is way left. */
  double stoppedFor(double seconds) const { return seconds - m_movedAt; }

 private:
  bool wantsReactive(const DriveState& state, const ObstaclePoints& obstacles) const;
  void setWaypoints(const DriveState& state, const ObstaclePoints& obstacles);
  bool isOpen(const semantic_planning::PathPoint& place, const DriveState& state,
              const ObstaclePoints& obstacles) const;
  DriveCommand driveReactively(const DriveState& state, const ObstaclePoints& obstacles,
                               double speedLimit, double seconds);
  std::function<mrpt::math::TPose2D(double)> wayAhead(const DriveState& state,
                                                      const DriveCommand& wanted) const;
  DriveCommand besideMovers(const DriveState& state, DriveCommand wanted,
                            const DynamicObstacles& movers) const;
  Motion safeMotion(const DriveState& state, const DriveCommand& wanted,
                    const ObstaclePoints& obstacles, double since) const;
  bool isSafe(Motion motion, const DriveCommand& wanted, const ObstaclePoints& obstacles) const;

  PathTracker m_tracker;
  DrivenTrack m_track;
  ReactiveNavigator m_reactive;
  bool m_isReactive = false;
  Motion m_motion;
  std::optional<double> m_steppedAt;  ///< seconds
  double m_movedAt = 0;
  double m_reactiveFrom = -1;  ///< beginning of the stretch that the reactive navigator drives
  std::vector<semantic_planning::PathPoint> m_waypoints;
  double m_reactiveAgain = 0;  ///< seconds: it is not asked before, as it found no way
};

}  // namespace semantic_driving
