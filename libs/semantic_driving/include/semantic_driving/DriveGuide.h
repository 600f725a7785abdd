#pragma once
#include <semantic_driving/DriveController.h>
#include <semantic_driving/Explorer.h>
#include <semantic_driving/GuideTransitions.h>
#include <semantic_driving/ObstacleSensing.h>
#include <semantic_driving/PathCheck.h>

#include <optional>
#include <string>

namespace semantic_driving {

/** A goal where the vehicle does not fit, by what the map shows. */
struct RefusedGoal {
  std::string reason;                          ///< what is in the way
  std::optional<mrpt::math::TPose2D> nearest;  ///< the nearest pose that fits
  double seconds = 0;                          ///< when it was said
};

/** Decides which path to drive, as the map grows. It leads to the goal, to a place from where to
 * see more of the way there, or out of where the vehicle must not be. Where there is no way out, as
 * behind somebody who stepped in front, it leads back along the vehicle's own track.
 *
 *     while (!guide.gaveUp() && !guide.arrived(state, drive)) {
 *       map.insert(...);                          // what was seen
 *       planner.update();
 *       guide.update(state, z, drive, seconds);
 *       const auto obstacles = senseObstacles(planner, state.pose, z, guide.obstacles());
 *       const DriveCommand command = drive.step(state, obstacles, sensorAge, seconds);
 *     }
 *
 * What it decides when is in GuideTransitions.h; it asks planner, frontiers and recovery for the
 * paths. Poses are in the map's frame. */
class DriveGuide {
 public:
  /** \param planner must outlive the guide. \throw std::invalid_argument bad options. */
  DriveGuide(const GuideOptions& options, semantic_planning::SemanticPlanner& planner,
             const mrpt::math::TPose2D& goal);

  /** After the map and the planner changed: gives the controller another path if there is a reason
   * to, an empty one if no path is left.
   * \param z height of the ground below the vehicle, meters \param seconds the time */
  void update(const DriveState& state, double z, DriveController& drive, double seconds);

  /** Whether it looks for a path, and should be asked again soon: searches are spread over calls, a
   * few hundredths of a second each. Meanwhile it goes on as before. */
  bool isSearching() const { return m_open.has_value(); }
  /** Gives up what it looks for; the next update() looks anew. */
  void stopSearching();
  Target target() const { return m_state.target; }
  /** Where it drives in the end: the goal, or in its place the nearest pose that fits. */
  const mrpt::math::TPose2D& goal() const { return m_aim; }
  /** Since it was said that the goal does not fit. */
  const std::optional<RefusedGoal>& refusal() const { return m_refusal; }
  /** The path to the goal is driven, and the vehicle stands. */
  bool arrived(const DriveState& state, const DriveController& drive) const;
  /** No path, and nothing else to look at, or the goal is enclosed (findFrontiers()) or does not
   * fit (findMisfit()); for good. */
  bool gaveUp() const { return m_state.gaveUp; }
  /** Why the last plan to the goal, or the recovery, was not found. */
  const std::string& reason() const { return m_reason; }
  /** What counts as an obstacle on the way that the vehicle is on: on the way out of forbidden
   * ground that ground does not. */
  ObstacleOptions obstacles() const;

  std::size_t explored() const { return m_explorer.explored(); }
  /** Paths that were given up for another one, before their end. */
  int replans() const { return m_state.replans; }
  /** The last plan that was found. */
  const semantic_planning::PlanResult& plan() const { return m_plan; }

 private:
  struct Situation {
    const DriveState& state;
    const DriveController& drive;
    double z, seconds;
  };
  /** Where a new path leaves the present one. */
  struct Departure {
    mrpt::math::TPose2D pose;
    double z;
    double along;  ///< the present path, meters
    bool isAhead;  ///< on that path; otherwise where the vehicle was when it asked
  };
  /** A question that is being answered. */
  struct Open {
    Departure from;
    bool enclosed = false;  ///< Exploration::enclosed
  };

  std::optional<GoalMisfit> misfit(const Situation& now) const;
  bool isNearGoal(const DriveState& state) const;
  Look look(const Situation& now) const;
  Departure departureOf(const Situation& now, bool ahead) const;
  bool isPast(const Departure& from, const Situation& now) const;
  DrivePath until(const Departure& from, const Situation& now) const;
  DrivePath untilRest(const Situation& now) const;
  void apply(Action::What what, const Situation& now, DriveController& drive);

  /** Leaves in m_found what it finds. \return none: it is still looking */
  std::optional<Answer> answer(const Action& question, const Situation& now);
  DrivePath joined(const Departure& from, const Situation& now, DrivePath path) const;
  bool improves(const Departure& from, const Situation& now);
  bool isEarly(const Situation& now) const;
  bool isBetter(const Situation& now) const;
  bool toGoal(bool ahead, const Situation& now);
  bool toFrontier(const Action& question, const Situation& now);
  std::optional<DrivePath> recovery(const Situation& now);
  std::optional<DrivePath> back(const Situation& now) const;
  bool aimsElsewhere(const Situation& now);

  GuideOptions m_options;
  semantic_planning::SemanticPlanner& m_planner;
  PathCheck m_check;
  ForwardTurns m_turns;
  Explorer m_explorer;
  const mrpt::math::TPose2D m_goal;
  mrpt::math::TPose2D m_aim;
  std::optional<GoalMisfit> m_misfit;  ///< as seen last
  std::optional<RefusedGoal> m_refusal;
  GuideState m_state;
  Action m_question;  ///< that is open
  std::optional<Open> m_open;
  std::size_t m_work = 0;            ///< that may still be done in this call
  std::optional<DrivePath> m_found;  ///< by the last question, if anything
  semantic_planning::PlanResult m_plan;
  bool m_planned = false;  ///< the planner's roadmap is for the goal
  std::string m_reason;
};

}  // namespace semantic_driving
