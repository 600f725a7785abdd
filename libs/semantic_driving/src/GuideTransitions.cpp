#include <semantic_driving/GuideTransitions.h>

#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <utility>

namespace semantic_driving {

const char* nameOf(Target target) {
  static constexpr const char* kNames[] = {"none", "goal", "frontier", "recovery", "back"};
  return kNames[static_cast<std::size_t>(target)];
}

namespace {

constexpr double kStuckAfter = 4;    // s without getting on, until another path is looked for
constexpr double kGiveUpAfter = 4;   // s at rest without any path
constexpr double kNearFrontier = 3;  // m before a frontier the next one is looked for
// A faster vehicle comes to rest before it leaves its path for another one, which may begin
// backwards; m/s.
constexpr double kSlow = 0.2;

using What = Action::What;

bool isStuck(const GuideState& state, const Look& look, const GuideOptions& options) {
  return look.stoppedFor >= kStuckAfter && look.seconds - state.changedAt >= options.patience;
}

/** For long. Notes since when. */
bool goalMisfits(GuideState& state, const Look& look, const GuideOptions& options) {
  if (!look.goalMisfits) state.misfitSince.reset();
  if (look.goalMisfits && !state.misfitSince) state.misfitSince = look.seconds;
  return state.misfitSince && look.seconds - *state.misfitSince >= options.goalPatience();
}

/** The path is at its end, leads where the vehicle need not go any more, or was blocked for long.
 * Notes since when it is blocked. */
bool mustChange(GuideState& state, const Look& look, const GuideOptions& options) {
  if (look.finished) return !look.hasPath || state.target != Target::Goal || !look.nearGoal;
  if (state.target == Target::Recovery && look.mayPlan) return true;
  if (state.target == Target::Goal || state.target == Target::Frontier) {
    if (!look.blocked) state.blockedSince.reset();
    if (look.blocked && !state.blockedSince) state.blockedSince = look.seconds;
    if (look.blocked && look.seconds - *state.blockedSince >= options.patience) return true;
  }
  return isStuck(state, look, options);
}

Transition choose(GuideState state, const Look& look) {
  if (!look.finished && look.speed > kSlow) {
    state.comesToRest = true;
    return {state, {What::ComeToRest}};
  }
  state.plannedAt = state.changedAt = look.seconds;
  if (!look.mayPlan) return {state, {What::SeekRecovery}};
  const bool replaces = std::exchange(state.comesToRest, false) || !look.finished;
  return {state, {What::SeekGoal, false, replaces, true}};
}

Transition improve(GuideState state, const Look& look) {
  state.plannedAt = look.seconds;
  const bool exploring = state.target == Target::Frontier;
  const bool next = exploring && look.left <= kNearFrontier;
  if (!look.mayPlanAhead || (exploring && !look.mayStandAtGoal && !next)) return {state, {}};
  return {state, {What::SeekGoal, true, !exploring, next}};
}

/** Takes a path that was found. */
Transition follow(GuideState state, Target target) {
  state.target = target;
  state.pathlessSince.reset();
  state.blockedSince.reset();
  return {state, {What::Follow}};
}

Transition followPlan(GuideState state, Target target, bool replaces) {
  state.hasPlanned = true;
  state.timesBack = 0;
  state.replans += replaces;
  return follow(state, target);
}

Transition fail(GuideState state, double seconds) {
  state.target = Target::None;
  state.blockedSince.reset();
  state.pathlessSince = state.pathlessSince.value_or(seconds);
  // A goal that does not fit has a patience of its own.
  state.gaveUp = seconds - *state.pathlessSince >= kGiveUpAfter && !state.misfitSince;
  return {state, {What::Stop}};
}

Transition goBack(GuideState state, double seconds) {
  if (state.timesBack >= GuideState::kMostTimesBack) return fail(state, seconds);
  return {state, {What::SeekBack}};
}

Transition afterGoal(GuideState state, const Answer& answer) {
  const auto [what, ahead, replaces, orFrontier, last] = answer.question;
  if (!answer.found) {
    const bool isLast = state.timesBack >= GuideState::kMostTimesBack;
    if (!orFrontier) return {state, {}};
    return {state, {What::SeekFrontier, ahead, replaces, false, isLast}};
  }
  if (ahead && (answer.empty || (replaces && !answer.better))) return {state, {}};
  return followPlan(state, Target::Goal, replaces);
}

Transition afterFrontier(GuideState state, const Answer& answer) {
  const bool ahead = answer.question.ahead;
  // What is seen until the next look may spare a change of gear.
  const bool waits = answer.empty || (answer.shunts && answer.early);
  if (answer.found && !(ahead && waits))
    return followPlan(state, Target::Frontier, answer.question.replaces);
  if (ahead) return {state, {}};
  // At the beginning it may stand where its sensors do not see the ground.
  const bool begins = !state.hasPlanned && state.timesBack == 0;
  return answer.enclosed && !begins ? fail(state, answer.seconds) : goBack(state, answer.seconds);
}

/** After a search for the nearest pose that fits: it is the goal, or there is none. */
Transition afterNearest(GuideState state, bool found) {
  state.misfitSince.reset();
  state.blockedSince.reset();
  const bool stands = state.target == Target::None;
  state.gaveUp = !found;
  state.comesToRest = found && !stands;
  if (!stands) state.target = found ? Target::Frontier : Target::None;  // till it has come to rest
  return {state, {stands ? What::Stop : What::ComeToRest}};
}

}  // namespace

Transition transition(GuideState state, const Look& look, const GuideOptions& options) {
  if (state.gaveUp) return {state, {look.finished ? What::Stop : What::GoOn}};
  if (goalMisfits(state, look, options)) return {state, {What::SeekNearest}};
  if (state.target == Target::None || mustChange(state, look, options)) return choose(state, look);
  const bool soon = look.seconds - state.plannedAt < GuideOptions::kPeriod;
  if (state.target == Target::Back || soon || state.blockedSince) return {state, {}};
  return improve(state, look);
}

Transition transition(GuideState state, const Answer& answer) {
  switch (answer.question.what) {
    case What::SeekGoal:
      return afterGoal(state, answer);
    case What::SeekFrontier:
      return afterFrontier(state, answer);
    case What::SeekRecovery:
      return answer.found ? follow(state, Target::Recovery) : goBack(state, answer.seconds);
    case What::SeekBack:
      if (!answer.found) return fail(state, answer.seconds);
      ++state.timesBack;
      return follow(state, Target::Back);
    case What::SeekNearest:
      return afterNearest(state, answer.found);
    default:
      return {state, {}};
  }
}

void GuideOptions::describe(strict_files::OptionList& list) {
  list.add(
      "patience", patience, "s", strict_files::atLeast(0),
      "wait for what stands in the way to go away, or to be passed; five times as long for what "
      "stands in the goal's place");
  list.add("drive_to_nearest", driveToNearest, "",
           "where the goal does not fit, drive to the nearest pose that does, within 5 m; off: "
           "stop, and say which it is");
  list.add("at_goal", atGoal, "m", strict_files::above(0),
           "distance from the goal that counts as arrived");
}

bool GuideOptions::isAsGood(const mrpt::math::TPose2D& pose,
                            const mrpt::math::TPose2D& goal) const {
  constexpr double kShare = 0.7, kHeading = 0.4;  // of what counts as there; rad
  return std::hypot(pose.x - goal.x, pose.y - goal.y) <= kShare * atGoal &&
         std::abs(mrpt::math::wrapToPi(pose.phi - goal.phi)) <= kHeading;
}

void GuideOptions::validate() const { strict_files::checkOptions(*this, "GuideOptions"); }

}  // namespace semantic_driving
