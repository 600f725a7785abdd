#pragma once
#include <mrpt/math/TPose2D.h>
#include <strict_files/OptionList.h>

#include <limits>
#include <optional>
#include <variant>

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
const strict_files::Choices<Target>& choicesOf(Target);
/** "none", "goal", "frontier", "recovery" or "back". */
const char* nameOf(Target target);

// What a guide does. Times are seconds of the clock that it is told.

/** There is no path; since when, if it looked for one. */
struct Idle {
  std::optional<double> since;
};
struct ToGoal {
  std::optional<double> blockedSince;
};
struct ToFrontier {
  std::optional<double> blockedSince;
};
/** On a way out of where the vehicle must not be. Blind: it does not see the ground below it, so
 * the way is driven to its end, else up to where it can plan. */
struct Recovering {
  bool blind = false;
  std::optional<double> blockedSince;
};
/** Back along the vehicle's track. */
struct GoingBack {};
/** For good. */
struct GaveUp {};
using Activity = std::variant<Idle, ToGoal, ToFrontier, Recovering, GoingBack, GaveUp>;

struct GuideState {
  Activity activity;
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  double plannedAt = kNever;                ///< a path was last looked for
  double changedAt = kNever;                ///< the same, and not one from a place ahead
  bool hasPlanned = false;                  ///< a path to the goal or a frontier was driven
  int timesBack = 0;                        ///< since then, back on its track
  static constexpr int kMostTimesBack = 3;  ///< then there is no path
  bool comesToRest = false;                 ///< before the end of its path, to take another one
  bool enclosed = false;                    ///< no way leads to the goal, whatever else is seen
  std::optional<double> misfitSince;        ///< what is known keeps the vehicle from the goal
  bool recoveredBlind = false;  ///< the last recovery that was looked for is for a blind vehicle
  int replans = 0;              ///< paths that were left for another one before their end

  Target target() const;
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

// What a guide does next. It takes paths as they are found, or asks for one more.

/** Goes on as before. */
struct GoOn {};
/** Has no path any more. */
struct Stop {};
/** Keeps so much of the path as it takes to come to rest. */
struct ComeToRest {};
/** Drives the path that was found. */
struct Follow {};

/** Where paths begin: where the vehicle is, or on its path a little ahead. */
enum class From { Here, Ahead };
struct SeekGoal {
  From from = From::Here;
  bool replaces = false;   ///< a path that was not driven to its end
  bool orFrontier = true;  ///< if there is no path to the goal
};
struct SeekFrontier {
  From from = From::Here;
  bool replaces = false;
  bool last = false;  ///< places that are not reached now are not looked for again
};
struct SeekRecovery {
  bool blind = false;
};
struct SeekBack {};
/** The pose nearest to a goal that does not fit, if it drives there in its place. */
struct SeekNearest {};
using Action = std::variant<GoOn, Stop, ComeToRest, Follow, SeekGoal, SeekFrontier, SeekRecovery,
                            SeekBack, SeekNearest>;

/** What came of a question (Seek...). */
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
