#pragma once
#include <semantic_driving/DriveOptions.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/vehicle/Footprint.h>

#include <filesystem>
#include <memory>

namespace semantic_driving {

/** MRPT's CReactiveNavigationSystem, step by step: waypoints and
 * obstacles go in, a command comes out. It drives forward only.
 *
 * MRPT takes the time from mrpt::Clock: let it tell the time of a simulation
 * (mrpt::Clock::setActiveClock()), if there is one. */
class ReactiveNavigator {
 public:
  struct Options {
    std::filesystem::path config;  ///< MRPT's .ini, see config/reactive
    semantic_planning::Footprint footprint;
    /** For what MRPT's navlog-viewer reads: log_000.reactivenavlog, or the next free number,
     * complete when the navigator is gone. Empty: none. */
    std::filesystem::path logFolder;
  };
  enum class Status { Idle, Driving, Arrived, Blocked };

  /** Computes the trajectories, which takes a moment.
   * \param limits speed and least radius of the trajectories, whatever the file says, and what is
   * kept free around the footprint
   * \throw std::exception the file is missing, or what MRPT does not like about it. */
  ReactiveNavigator(const Options& options, const DriveOptions& limits);
  ~ReactiveNavigator();

  /** Goes through these places one after the other, from now on.
   * \param reach how near is near enough, meters */
  void setWaypoints(const std::vector<semantic_planning::PathPoint>& waypoints, double reach);

  /** \param seconds of the clock that runs while navigating */
  DriveCommand step(const DriveState& state, const ObstaclePoints& obstacles, double seconds);
  /** After the last step. */
  Status status() const;

 private:
  struct Navigation;
  std::unique_ptr<Navigation> m_navigation;
};

}  // namespace semantic_driving
