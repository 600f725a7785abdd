#include <semantic_driving/GuideTransitions.h>

#include <mrpt/math/wrap2pi.h>

#include <array>
#include <cmath>
#include <utility>

namespace semantic_driving {

const strict_files::Choices<Target>& choicesOf(Target) {
  static const strict_files::Choices<Target> choices = {{"none", Target::None},
                                                        {"goal", Target::Goal},
                                                        {"frontier", Target::Frontier},
                                                        {"recovery", Target::Recovery},
                                                        {"back", Target::Back}};
  return choices;
}

const char* nameOf(Target target) { return strict_files::nameIn(choicesOf(target), target); }

namespace {

constexpr double kStuckAfter = 4;    // s without getting on, until another path is looked for
constexpr double kGiveUpAfter = 4;   // s at rest without any path
constexpr double kNearFrontier = 3;  // m before a frontier the next one is looked for
// A faster vehicle comes to rest before it leaves its path for another one, which may begin
// backwards; m/s.
constexpr double kSlow = 0.2;

template <class A>
bool does(const GuideState& state) {
  return std::holds_alternative<A>(state.activity);
}

/** Where it is kept since when the way is blocked; null if that does not matter. */
std::optional<double>* blockedSince(Activity& activity) {
  if (auto* a = std::get_if<ToGoal>(&activity)) return &a->blockedSince;
  if (auto* a = std::get_if<ToFrontier>(&activity)) return &a->blockedSince;
  auto* a = std::get_if<Recovering>(&activity);
  return a && a->blind ? &a->blockedSince : nullptr;
}

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
  if (look.finished) return !look.hasPath || !(does<ToGoal>(state) && look.nearGoal);
  if (const auto* recovering = std::get_if<Recovering>(&state.activity);
      recovering && !recovering->blind && look.mayPlan)
    return true;
  if (auto* since = blockedSince(state.activity)) {
    if (!look.blocked) since->reset();
    if (look.blocked && !*since) *since = look.seconds;
    if (*since && look.seconds - **since >= options.patience) return true;
  }
  return isStuck(state, look, options);
}

Transition choose(GuideState state, const Look& look) {
  if (!look.finished && look.speed > kSlow) {
    state.comesToRest = true;
    return {state, ComeToRest{}};
  }
  state.plannedAt = state.changedAt = look.seconds;
  if (!look.mayPlan) {
    state.recoveredBlind = false;
    return {state, SeekRecovery{false}};
  }
  const bool replaces = std::exchange(state.comesToRest, false) || !look.finished;
  return {state, SeekGoal{From::Here, replaces, true}};
}

Transition improve(GuideState state, const Look& look) {
  state.plannedAt = look.seconds;
  const bool exploring = does<ToFrontier>(state);
  const bool next = exploring && look.left <= kNearFrontier;
  if (!look.mayPlanAhead || (exploring && !look.mayStandAtGoal && !next)) return {state, GoOn{}};
  return {state, SeekGoal{From::Ahead, !exploring, next}};
}

/** Takes a path that was found. */
Transition follow(GuideState state, Activity activity) {
  state.activity = activity;
  return {state, Follow{}};
}

Transition followPlan(GuideState state, Activity activity, bool replaces) {
  state.hasPlanned = true;
  state.timesBack = 0;
  if (replaces) ++state.replans;
  return follow(state, activity);
}

Transition fail(GuideState state, double seconds) {
  const auto* idle = std::get_if<Idle>(&state.activity);
  const double since = idle && idle->since ? *idle->since : seconds;
  state.activity = Idle{since};
  // A goal that does not fit has a patience of its own.
  if (seconds - since >= kGiveUpAfter && !state.misfitSince) state.activity = GaveUp{};
  return {state, Stop{}};
}

Transition goBack(GuideState state, double seconds) {
  if (state.timesBack >= GuideState::kMostTimesBack) return fail(state, seconds);
  return {state, SeekBack{}};
}

Transition after(GuideState state, const SeekGoal& sought, const Answer& answer) {
  const bool ahead = sought.from == From::Ahead;
  if (!answer.found) {
    if (!sought.orFrontier) return {state, GoOn{}};
    const bool last = state.timesBack >= GuideState::kMostTimesBack;
    return {state, SeekFrontier{sought.from, sought.replaces, last}};
  }
  if (ahead && (answer.empty || (sought.replaces && !answer.better))) return {state, GoOn{}};
  return followPlan(state, ToGoal{}, sought.replaces);
}

Transition after(GuideState state, const SeekFrontier& sought, const Answer& answer) {
  const bool ahead = sought.from == From::Ahead;
  state.enclosed = answer.enclosed;
  // What is seen until the next look may spare a change of gear.
  const bool waits = answer.empty || (answer.shunts && answer.early);
  if (answer.found && !(ahead && waits)) return followPlan(state, ToFrontier{}, sought.replaces);
  if (ahead) return {state, GoOn{}};
  // At the beginning it may stand where its sensors do not see the ground.
  if (does<Idle>(state) && !state.hasPlanned && !(state.enclosed && state.recoveredBlind)) {
    state.recoveredBlind = true;
    return {state, SeekRecovery{true}};
  }
  if (state.enclosed) return fail(state, answer.seconds);
  return goBack(state, answer.seconds);
}

Transition after(GuideState state, const SeekRecovery& sought, const Answer& answer) {
  if (answer.found) return follow(state, Recovering{sought.blind, {}});
  return goBack(state, answer.seconds);
}

Transition after(GuideState state, const SeekBack&, const Answer& answer) {
  if (!answer.found) return fail(state, answer.seconds);
  ++state.timesBack;
  return follow(state, GoingBack{});
}

/** After a search for the nearest pose that fits: it is the goal, or there is none. */
Transition after(GuideState state, const SeekNearest&, const Answer& answer) {
  state.misfitSince.reset();
  if (!answer.found) {
    const bool stands = does<Idle>(state);
    state.activity = GaveUp{};
    return {state, stands ? Action(Stop{}) : ComeToRest{}};
  }
  if (does<Idle>(state)) return {state, Stop{}};
  state.activity = ToFrontier{};  // as far as it takes to come to rest
  state.comesToRest = true;
  return {state, ComeToRest{}};
}

/** No question. */
template <class Other>
Transition after(GuideState state, const Other&, const Answer&) {
  return {state, GoOn{}};
}

}  // namespace

Target GuideState::target() const {
  static constexpr std::array<Target, std::variant_size_v<Activity>> kTargets = {
      Target::None, Target::Goal, Target::Frontier, Target::Recovery, Target::Back, Target::None};
  return kTargets[activity.index()];
}

Transition transition(GuideState state, const Look& look, const GuideOptions& options) {
  if (does<GaveUp>(state)) return {state, look.finished ? Action(Stop{}) : GoOn{}};
  if (goalMisfits(state, look, options)) return {state, SeekNearest{}};
  if (does<Idle>(state) || mustChange(state, look, options)) return choose(state, look);
  const auto* blocked = blockedSince(state.activity);
  const bool soon = look.seconds - state.plannedAt < GuideOptions::kPeriod;
  if (does<GoingBack>(state) || soon || (blocked && *blocked)) return {state, GoOn{}};
  return improve(state, look);
}

Transition transition(GuideState state, const Answer& answer) {
  return std::visit([&](const auto& question) { return after(std::move(state), question, answer); },
                    answer.question);
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
