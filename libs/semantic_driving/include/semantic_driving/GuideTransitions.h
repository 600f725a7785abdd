#pragma once
#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>

#include <limits>
#include <optional>

namespace semantic_driving {

/** When a guide looks for paths, and where. */
struct GuideOptions {
  static constexpr double kPeriod = 1;  ///< seconds between looks for a better path
  double patience = 2.0;        ///< seconds for what stands in the way to go away, or to be passed
  bool driveToNearest = false;  ///< the nearest pose that fits becomes the goal then
  double atGoal = 0.3;          ///< so near (meters) to the goal's place is there

  /** Seconds for what stands in the goal's place to go away, before the goal is said not to fit:
   * people move, walls do not. */
  double goalPatience() const { return 5 * patience; }
  void describe(strict_files::OptionList& list);
  /** Who is there is at the goal, though not to the last centimeter. */
  bool isAsGood(const mrpt::math::TPose2D& pose, const mrpt::math::TPose2D& goal) const;
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Where a path leads: nowhere, to the goal, to a look-out, out of where the vehicle must not be,
 * back along its own track. */
enum class Target { None, Goal, Frontier, Recovery, Back };
/** "none", "goal", "frontier", "recovery" or "back". */
const char* nameOf(Target target);

/** What a guide does. Times are seconds of the clock that it is told. */
struct GuideState {
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  static constexpr int kMostTimesBack = 3;
  Target target = Target::None;
  bool gaveUp = false;                  ///< for good
  double plannedAt = kNever;            ///< a path was last looked for
  double changedAt = kNever;            ///< the same, and not one from a place ahead
  std::optional<double> pathlessSince;  ///< it looked for a path in vain
  std::optional<double> blockedSince;   ///< the path to the goal or a frontier
  std::optional<double> misfitSince;    ///< what is known keeps the vehicle from the goal
  bool hasPlanned = false;              ///< a path to the goal or a frontier was driven
  int timesBack = 0;         ///< back on its track since a path to the goal or a frontier
  bool comesToRest = false;  ///< before the end of its path, to take another one
  int replans = 0;           ///< paths that were left for another one before their end
};

/** What a guide sees each time it is asked. */
struct Look {
  double seconds = 0;
  double speed = 0;       ///< m/s, 0 or more
  double stoppedFor = 0;  ///< seconds since the vehicle last got on
  double left = 0;        ///< meters of the path
  bool hasPath = false, finished = true;
  bool nearGoal = false;       ///< the vehicle is at the goal's place
  bool blocked = false;        ///< the path ahead
  bool mayPlan = true;         ///< from where the vehicle is
  bool mayPlanAhead = true;    ///< from where a better path leaves the present one
  bool mayStandAtGoal = true;  ///< by what is known
  /** Whatever is yet to be seen (findMisfit()), or though nothing is left to be looked at. */
  bool goalMisfits = false;
};

/** What a guide does next. It takes paths as they are found, or asks for one more. */
struct Action {
  enum class What {
    GoOn,        ///< as before
    Stop,        ///< it has no path any more
    ComeToRest,  ///< keeps so much of the path as that takes
    Follow,      ///< drives the path that was found
    SeekGoal,
    SeekFrontier,
    SeekRecovery,
    SeekBack,
    SeekNearest  ///< the pose nearest to a goal that does not fit, if it drives there in its place
  };
  What what = What::GoOn;
  bool ahead = false;       ///< the path begins on the present one, a little ahead of the vehicle
  bool replaces = false;    ///< it replaces a path that was not driven to its end
  bool orFrontier = false;  ///< SeekGoal: to one, if there is no path to the goal
  bool last = false;        ///< SeekFrontier: what is not reached now is not looked for again

  bool isQuestion() const { return what >= What::SeekGoal; }
};

/** What came of a question. */
struct Answer {
  Action question;
  double seconds = 0;     ///< as in Look
  bool found = false;     ///< a path, or a pose
  bool empty = false;     ///< it is there already
  bool better = false;    ///< clearly, than the present path
  bool shunts = false;    ///< the path changes its gear, or that of the present one
  bool early = false;     ///< there is time for another look before the present path is at its end
  bool enclosed = false;  ///< of SeekFrontier: Exploration::enclosed
};

struct Transition {
  GuideState state;
  Action action;
};

/** The state machine of DriveGuide, without planner and map: what follows a look, or the answer to
 * a question. \param options valid */
Transition transition(GuideState state, const Look& look, const GuideOptions& options);
Transition transition(GuideState state, const Answer& answer);

}  // namespace semantic_driving
