#include <mrpt/core/format.h>
#include <semantic_driving/DriveGuide.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "Recovery.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;
using What = Action::What;

namespace {

// A better path leaves the present one where the vehicle is after so many seconds, or at least so
// many meters ahead.
constexpr double kLeadTime = 1, kLeadDistance = 0.5;
constexpr double kRestMargin = 0.1;      // m more than coming to rest takes
constexpr double kShortestShunt = 0.15;  // m; shorter last stretches are not worth a change of gear
constexpr double kNearestWithin = 5;     // m around a goal that does not fit
// Searches do so much of their work in a call, as SemanticPlanner::goOn() counts it.
constexpr std::size_t kWork = 60000;

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/** A pose as command lines have it. */
std::string textOf(const TPose2D& pose) {
  return mrpt::format("%.2f,%.2f,%.0f", pose.x, pose.y, pose.phi * 180 / M_PI);
}

std::string reasonOf(const Exploration& enclosed) {
  if (!std::isfinite(enclosed.goalArea)) return "the vehicle is enclosed by what it cannot pass";
  const long area = std::lround(std::ceil(enclosed.goalArea));
  return "the goal, with " + std::to_string(area) +
         " square meters around it, "
         "is enclosed by what the vehicle cannot pass";
}

}  // namespace

DriveGuide::DriveGuide(const GuideOptions& options, SemanticPlanner& planner, const TPose2D& goal)
    : m_options(options),
      m_planner(planner),
      m_check(planner),
      m_turns(planner),
      m_explorer(planner),
      m_goal(goal),
      m_aim(goal) {
  m_options.validate();
}

void DriveGuide::update(const DriveState& state, double z, DriveController& drive, double seconds) {
  const Situation now{state, drive, z, seconds};
  const bool gaveUpBefore = gaveUp();
  m_explorer.moveTo(state.pose, z);
  m_misfit = misfit(now);
  m_work = kWork;
  if (m_open && isPast(m_open->from, now)) m_open.reset();
  Transition next =
      m_open ? Transition{m_state, m_question} : transition(m_state, look(now), m_options);
  while (next.action.isQuestion()) {
    const std::optional<Answer> answer = this->answer(next.action, now);
    m_state = next.state;
    m_question = next.action;
    if (!answer) return;
    m_open.reset();
    next = transition(m_state, *answer);
  }
  m_state = next.state;
  apply(next.action.what, now, drive);
  if (gaveUp() && !gaveUpBefore && explored() > 0)
    m_reason += "; frontiers explored: " + std::to_string(explored());
}

void DriveGuide::stopSearching() {
  m_open.reset();
  m_explorer.giveUp();
  m_planner.forget();
  m_planned = false;
}

/** Where it fits nothing is looked for, nor where it stands or is about to. */
std::optional<GoalMisfit> DriveGuide::misfit(const Situation& now) const {
  const double far = distance(now.state.pose, m_aim);
  if (far < m_options.atGoal || far > kFrontierRadius) return {};
  if (m_planner.check(m_aim) == PlanStatus::Found) return {};
  return findMisfit(m_planner, now.state.pose, now.z, m_aim);
}

bool DriveGuide::isNearGoal(const DriveState& state) const {
  return distance(state.pose, m_aim) < m_options.atGoal;
}

bool DriveGuide::arrived(const DriveState& state, const DriveController& drive) const {
  const PathTracker& tracker = drive.tracker();
  return target() == Target::Goal && isNearGoal(state) && !tracker.path().empty() &&
         tracker.finished() && std::abs(state.speed) < DriveOptions::kAtRest;
}

ObstacleOptions DriveGuide::obstacles() const {
  ObstacleOptions options;
  options.forbiddenGround = target() != Target::Recovery;
  return options;
}

Look DriveGuide::look(const Situation& now) const {
  const PathTracker& tracker = now.drive.tracker();
  const auto mayStand = [this](const TPose2D& pose, std::optional<double> z) {
    return m_planner.check(pose, z) == PlanStatus::Found;
  };
  Look look;
  look.seconds = now.seconds;
  look.speed = std::abs(now.state.speed);
  look.stoppedFor = now.drive.stoppedFor(now.seconds);
  look.left = tracker.path().length() - tracker.progress();
  look.hasPath = !tracker.path().empty();
  look.finished = tracker.finished();
  look.nearGoal = isNearGoal(now.state);
  look.blocked = !look.finished && !m_check.judge(tracker.path(), tracker.progress()).isFree();
  look.mayPlan = mayStand(now.state.pose, now.z);
  const Departure ahead = departureOf(now, true);
  look.mayPlanAhead = mayStand(ahead.pose, ahead.z);
  look.mayStandAtGoal = mayStand(m_aim, {});
  look.goalMisfits = m_misfit || (m_explorer.exhausted() && !look.mayStandAtGoal);
  return look;
}

DriveGuide::Departure DriveGuide::departureOf(const Situation& now, bool ahead) const {
  const PathTracker& tracker = now.drive.tracker();
  if (!ahead || tracker.finished()) return {now.state.pose, now.z, 0, false};
  const DrivePath& path = tracker.path();
  const double here = tracker.progress();
  const double lead = std::max(kLeadDistance, std::abs(now.state.speed) * kLeadTime);
  const double there = std::min(path.stretchEnd(here), here + lead);
  return {poseOf(path.at(there)), path.at(there).z, there, true};
}

/** Whether the vehicle cannot leave from there any more. */
bool DriveGuide::isPast(const Departure& from, const Situation& now) const {
  constexpr double kMoved = 0.05;  // m; somebody made it step aside
  const PathTracker& tracker = now.drive.tracker();
  if (!from.isAhead) return distance(from.pose, now.state.pose) > kMoved;
  return tracker.finished() || tracker.progress() > from.along;
}

/** From the vehicle to where it leaves the present path. */
DrivePath DriveGuide::until(const Departure& from, const Situation& now) const {
  const PathTracker& tracker = now.drive.tracker();
  return from.isAhead ? tracker.path().part(tracker.progress(), from.along) : DrivePath();
}

/** The present path as far as the vehicle needs to come to rest: another one begins with a vehicle
 * that stands, and may begin backwards. */
DrivePath DriveGuide::untilRest(const Situation& now) const {
  const PathTracker& tracker = now.drive.tracker();
  const DrivePath& path = tracker.path();
  const double here = tracker.progress();
  const double there =
      here + restingWay(std::abs(now.state.speed), tracker.options()) + kRestMargin;
  return path.part(here, std::min(there, path.stretchEnd(here)));
}

void DriveGuide::apply(What what, const Situation& now, DriveController& drive) {
  if (what == What::Follow) drive.setPath(std::move(*m_found));
  if (what == What::ComeToRest) drive.setPath(untilRest(now));
  if (what == What::Stop) drive.setPath({});
  m_explorer.end(what == What::Follow);
  m_found.reset();
}

std::optional<Answer> DriveGuide::answer(const Action& question, const Situation& now) {
  Answer answer{question, now.seconds};
  if (question.what == What::SeekNearest) {
    answer.found = aimsElsewhere(now);
    return answer;
  }
  if (question.what == What::SeekGoal && !toGoal(question.ahead, now)) return {};
  if (question.what == What::SeekFrontier && !toFrontier(question, now)) return {};
  if (question.what == What::SeekRecovery) m_found = recovery(now);
  if (question.what == What::SeekBack) m_found = back(now);
  if (question.what == What::SeekGoal && question.ahead && question.replaces)
    answer.better = improves(m_open->from, now);
  answer.found = m_found.has_value();
  answer.empty = m_found && m_found->empty();
  answer.shunts = m_found && !m_found->empty() && m_found->stretchEnd(0) < m_found->length();
  answer.early = isEarly(now);
  answer.enclosed = m_open && m_open->enclosed;
  return answer;
}

/** A path begins where it leaves the present one. */
DrivePath DriveGuide::joined(const Departure& from, const Situation& now, DrivePath path) const {
  if (path.empty()) return path;
  const DrivePath before = until(from, now);
  if (!before.empty()) path = before.part(0, before.length(), path);
  return m_turns.find(path, before.length(), PathJudgment::kSameLength).value_or(path);
}

/** If the find is no better than the present path, it is its rest with a turn ahead for which there
 * was no room before. */
bool DriveGuide::improves(const Departure& from, const Situation& now) {
  if (isBetter(now)) return true;
  const PathTracker& tracker = now.drive.tracker();
  m_found = m_turns.find(tracker.path().part(tracker.progress(), tracker.path().length()),
                         until(from, now).length(), PathJudgment::kSameLength);
  return m_found.has_value();
}

/** Whether it still drives its path when it looks the next time. */
bool DriveGuide::isEarly(const Situation& now) const {
  const PathTracker& tracker = now.drive.tracker();
  return tracker.path().length() - tracker.progress() >
         std::abs(now.state.speed) * GuideOptions::kPeriod;
}

/** What was found than the present path. */
bool DriveGuide::isBetter(const Situation& now) const {
  if (!m_found || m_found->empty()) return false;
  const PathTracker& tracker = now.drive.tracker();
  return m_check.judge(*m_found, 0)
      .isClearlyBetterThan(m_check.judge(tracker.path(), tracker.progress()));
}

/** \return whether it is known if there is a path */
bool DriveGuide::toGoal(bool ahead, const Situation& now) {
  if (!m_open) {
    m_open = Open{departureOf(now, ahead)};
    m_planner.begin(m_open->from.pose, m_planned ? std::nullopt : std::optional(m_aim),
                    m_open->from.z);
    m_planned = m_planner.hasPlanned();
  }
  std::optional<PlanResult> plan = m_planner.goOn(m_work);
  if (!plan) return false;
  m_found.reset();
  if (!plan->found()) {
    m_reason = plan->reason;
    return true;
  }
  DrivePath path(plan->path);
  m_plan = std::move(*plan);
  const double last = path.stretchBegin(path.length());
  const bool isWorthIt = last <= 0 || path.length() - last >= kShortestShunt;
  m_found = joined(m_open->from, now, isWorthIt ? path : path.part(0, last));
  return true;
}

/** \return whether it is known if there is a path */
bool DriveGuide::toFrontier(const Action& question, const Situation& now) {
  if (!m_open) {
    m_open = Open{departureOf(now, question.ahead)};
    m_explorer.begin(m_open->from.pose, m_open->from.z, m_aim);
  }
  const auto joinedTo = [&](DrivePath path) { return joined(m_open->from, now, std::move(path)); };
  const bool isChosen = m_explorer.goOn(joinedTo, m_work);
  const Exploration& places = m_explorer.found();
  m_planned = m_planned && places.frontiers.empty();
  if (!isChosen) return false;
  m_open->enclosed = places.enclosed;
  if (places.enclosed) m_reason = reasonOf(places);
  auto way = m_explorer.chosen(question.last);
  m_found.reset();
  if (!way) return true;
  m_plan = std::move(way->plan);
  m_found = std::move(way->path);
  return true;
}

std::optional<DrivePath> DriveGuide::recovery(const Situation& now) {
  DrivePath path = findRecovery(m_planner, now.state.pose, now.z);
  if (!path.empty()) return path;
  m_reason = "the vehicle is where it must not be, and finds no way out";
  return {};
}

/** Says that the goal does not fit, and offers the nearest pose that does, unless that is as good.
 * \return whether it drives there from now on */
bool DriveGuide::aimsElsewhere(const Situation& now) {
  const auto nearest = nearestFit(m_planner, now.state.pose, now.z, m_goal, kNearestWithin);
  const bool asGood = nearest && m_options.isAsGood(*nearest, m_goal);
  if (nearest && *nearest == m_aim) return false;  // there it was, and found no way
  if (!asGood) {
    m_refusal = RefusedGoal{
        m_misfit ? describe(*m_misfit, m_aim, m_planner.ground().map().classes()) : m_reason,
        nearest, now.seconds};
    m_reason = m_refusal->reason + "; the nearest pose known to fit: ";
    m_reason += nearest ? textOf(*nearest) : "none";
  }
  if (!nearest || !(asGood || m_options.driveToNearest)) return false;
  m_aim = *nearest;
  m_planned = false;
  return true;
}

/** Along the vehicle's own track to where it can plan, and a little on, for what is close may be
 * out of its sensors' sight. Without a track, out of what they do not see. */
std::optional<DrivePath> DriveGuide::back(const Situation& now) const {
  std::vector<PathPoint> points = now.drive.track().back();
  double z = now.z;
  for (PathPoint& p : points) {
    const auto ground = m_planner.ground().find(p.x, p.y, z);
    if (ground) z = m_planner.ground().centerOf(ground->surface.z);
    p.z = z;
  }
  const DrivePath track(std::move(points));
  constexpr double kStep = 0.2, kBeyond = 1, kBlind = 2;  // m
  for (double s = kStep; s < track.length(); s += kStep) {
    const PathPoint p = track.at(s);
    if (m_planner.check(poseOf(p), p.z) == PlanStatus::Found)
      return track.part(0, std::min(track.length(), s + kBeyond));
  }
  DrivePath out;
  if (track.length() < kStep) out = findRecovery(m_planner, now.state.pose, now.z, kBlind);
  return out.empty() ? std::nullopt : std::optional(out);
}

}  // namespace semantic_driving
