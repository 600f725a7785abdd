#pragma once
#include <semantic_planning/DriveController.h>
#include <semantic_planning/DrivePathCheck.h>

#include <optional>
#include <string>

#include "DriveConfig.h"

namespace semantic_map_drive {

/** Decides which path to drive, as the map grows: to the goal, to a place from where to see more of
 * the way there, or out of where the robot must not be. */
class Guide {
 public:
  enum class Target { None, Goal, Frontier, WayOut };

  /** \param planner must outlive the guide. */
  Guide(const GuideConfig& config, semantic_planning::SemanticPlanner& planner,
        const mrpt::math::TPose2D& goal);

  /** After the map changed. \param z height of the ground below the robot, meters
   * \return another path than before, from where the robot is; or nothing if it is to go on */
  std::optional<semantic_planning::DrivePath> update(
      const semantic_planning::DriveState& state, double z,
      const semantic_planning::DriveController& drive, double seconds);

  Target target() const { return m_target; }
  /** Paths that were given up for another one, before their end. */
  int replans() const { return m_replans; }
  /** No path, and nothing else to look at. */
  bool gaveUp() const { return m_gaveUp; }
  const std::string& reason() const { return m_reason; }
  /** The last plan, for the report. */
  const semantic_planning::PlanResult& plan() const { return m_plan; }

 private:
  struct Situation {
    const semantic_planning::DriveState& state;
    const semantic_planning::DriveTracker& tracker;
    double z, seconds;
  };
  /** Where a new path leaves the present one. */
  struct Departure {
    mrpt::math::TPose2D pose;
    double z;
    semantic_planning::DrivePath before;  ///< from the robot to there; may be empty
  };

  bool mustChange(const Situation& now, double stoppedFor);
  bool isBlocked(const Situation& now);
  Departure departureOf(const Situation& now, bool anew) const;
  std::optional<semantic_planning::DrivePath> choose(const Situation& now);
  std::optional<semantic_planning::DrivePath> improve(const Situation& now);
  std::optional<semantic_planning::DrivePath> wayOut(const Situation& now, double nearest);
  std::optional<semantic_planning::DrivePath> toGoal(const Departure& from);
  std::optional<semantic_planning::DrivePath> toFrontier(const Departure& from);
  void take(Target target, const Situation& now);
  void fail(const Situation& now);

  GuideConfig m_config;
  semantic_planning::SemanticPlanner& m_planner;
  semantic_planning::DrivePathCheck m_check;
  mrpt::math::TPose2D m_goal;
  Target m_target = Target::None;
  semantic_planning::PlanResult m_plan;
  bool m_planned = false;                   ///< the planner's roadmap is for the goal
  std::vector<mrpt::math::TPose2D> m_seen;  ///< frontiers that were visited, or not to be reached
  double m_plannedAt = -1e9, m_blockedSince = -1, m_withoutSince = -1;
  int m_replans = 0, m_plannedPaths = 0;
  bool m_blindOut = false;  ///< the way out leads to its end, whatever is below the robot
  bool m_gaveUp = false;
  std::string m_reason;
};

const char* nameOf(Guide::Target target);

}  // namespace semantic_map_drive
