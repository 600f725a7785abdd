#pragma once
#include <semantic_driving/DriveController.h>
#include <semantic_driving/DrivePathCheck.h>
#include <semantic_driving/ObstacleSensing.h>

#include <optional>
#include <string>
#include <vector>

namespace semantic_driving {

/** When a guide looks for paths. */
struct GuideOptions {
  double period = 1.0;       ///< seconds between looks for a better path
  double patience = 2.0;     ///< seconds for what stands in the way to go away, or to be passed
  double giveUpAfter = 4.0;  ///< seconds at rest without any path
  double atGoal = 0.3;       ///< so near (meters) to the goal's place is there

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** Decides which path to drive, as the map grows: to the goal, to a place from where to see more of
 * the way there, or out of where the vehicle must not be; where there is no way out, as behind
 * somebody who stepped in front, back along its own track until it can plan again.
 *
 *     while (!guide.gaveUp() && !guide.arrived(state, drive)) {
 *       map.insert(...);                          // what was seen
 *       planner.update();
 *       guide.update(state, z, drive, seconds);
 *       const auto obstacles = senseObstacles(planner, state.pose, z, guide.obstacles());
 *       const DriveCommand command = drive.step(state, obstacles, sensorAge, seconds);
 *     }
 *
 * Poses are in the map's frame. */
class DriveGuide {
 public:
  enum class Target { None, Goal, Frontier, WayOut, Back };

  /** \param planner must outlive the guide. \throw std::invalid_argument bad options. */
  DriveGuide(const GuideOptions& options, semantic_planning::SemanticPlanner& planner,
             const mrpt::math::TPose2D& goal);

  /** After the map changed and the planner was brought up to date: gives the controller another
   * path if there is a reason to, an empty one if there is none at all.
   * \param z height of the ground below the vehicle, meters \param seconds the time */
  void update(const DriveState& state, double z, DriveController& drive, double seconds);

  Target target() const { return m_target; }
  /** The path to the goal is driven, and the vehicle stands. */
  bool arrived(const DriveState& state, const DriveController& drive) const;
  /** No path, and nothing else to look at, or the goal is enclosed (findFrontiers()). */
  bool gaveUp() const { return m_gaveUp; }
  /** Why the last plan to the goal, or the way out, was not found. */
  const std::string& reason() const { return m_reason; }
  /** What counts as an obstacle on the way that the vehicle is on: on the way out of forbidden
   * ground that ground does not. \param usual options for all other ways */
  ObstacleOptions obstacles(ObstacleOptions usual = {}) const;

  /** Places at the border of what is known that were driven to, or could not be reached. None is
   * looked at twice, nor others within FrontierOptions::apart of it: exploring comes to an end. */
  std::size_t explored() const { return m_seen.size(); }
  /** Paths that were given up for another one, before their end. */
  int replans() const { return m_replans; }
  /** The last plan that was found. */
  const semantic_planning::PlanResult& plan() const { return m_plan; }

 private:
  struct Situation {
    const DriveState& state;
    const DriveTracker& tracker;
    const DriveTrack& track;
    double z, seconds, stoppedFor;
  };
  /** Where a new path leaves the present one. */
  struct Departure {
    mrpt::math::TPose2D pose;
    double z;
    DrivePath before;  ///< from the vehicle to there; may be empty
  };

  std::optional<DrivePath> next(const Situation& now);
  bool mustChange(const Situation& now);
  bool isBlocked(const Situation& now);
  bool isStuck(const Situation& now) const;
  Departure departureOf(const Situation& now, bool anew) const;
  static DrivePath untilRest(const Situation& now);
  std::optional<DrivePath> choose(const Situation& now);
  std::optional<DrivePath> improve(const Situation& now);
  std::optional<DrivePath> wayOut(const Situation& now, double nearest);
  std::optional<DrivePath> goBack(const Situation& now);
  std::optional<DrivePath> toGoal(const Departure& from);
  std::optional<DrivePath> toFrontier(const Departure& from);
  bool isNearGoal(const DriveState& state) const;
  void take(Target target, const Situation& now);
  void fail(const Situation& now);

  GuideOptions m_options;
  semantic_planning::SemanticPlanner& m_planner;
  DrivePathCheck m_check;
  mrpt::math::TPose2D m_goal;
  Target m_target = Target::None;
  semantic_planning::PlanResult m_plan;
  bool m_planned = false;                   ///< the planner's roadmap is for the goal
  std::vector<mrpt::math::TPose2D> m_seen;  ///< frontiers that were visited, or not to be reached
  double m_plannedAt = -1e9, m_blockedSince = -1, m_withoutSince = -1;
  int m_replans = 0, m_plannedPaths = 0;
  int m_timesBack = 0;      ///< since a path was planned
  bool m_blindOut = false;  ///< the way out leads to its end, whatever is below the vehicle
  bool m_leaving = false;   ///< comes to rest before the end of its path
  bool m_enclosed = false;  ///< no way leads to the goal, whatever else is seen
  bool m_gaveUp = false;
  std::string m_reason;
};

/** "goal", "frontier", "way out", "back" or "none". */
const char* nameOf(DriveGuide::Target target);

}  // namespace semantic_driving
