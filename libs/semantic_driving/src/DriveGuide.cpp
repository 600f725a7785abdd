#include <semantic_driving/DriveFrontier.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_driving/DriveWayOut.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <strict_files/OptionChecks.h>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::PathPoint;
using semantic_planning::PlanResult;
using semantic_planning::PlanStatus;
using semantic_planning::SemanticPlanner;

namespace {

constexpr double kNearFrontier = 3;  // m: the next one is looked for before the vehicle stops
constexpr double kBlind = 2;         // m: the sensors do not see the ground nearer than this
constexpr double kAtRest = 0.05;     // m/s
constexpr double kSlow = 0.2;        // m/s
constexpr double kBackBy = 1;        // m, beyond where planning is possible again
constexpr int kTimesBack = 3;        // then it gives up

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::string reasonOf(const Exploration& enclosed) {
  if (!std::isfinite(enclosed.goalArea)) return "the vehicle is enclosed by what it cannot pass";
  const long area = std::lround(std::ceil(enclosed.goalArea));
  return "the goal, with " + std::to_string(area) +
         " square meters around it, "
         "is enclosed by what the vehicle cannot pass";
}

}  // namespace

const char* nameOf(DriveGuide::Target target) {
  switch (target) {
    case DriveGuide::Target::Goal:
      return "goal";
    case DriveGuide::Target::Frontier:
      return "frontier";
    case DriveGuide::Target::WayOut:
      return "way out";
    case DriveGuide::Target::Back:
      return "back";
    default:
      return "none";
  }
}

void GuideOptions::validate() const {
  const strict_files::OptionChecks check("GuideOptions");
  check.notNegative("period", period);
  check.notNegative("patience", patience);
  check.notNegative("giveUpAfter", giveUpAfter);
  check.positive("atGoal", atGoal);
}

DriveGuide::DriveGuide(const GuideOptions& options, SemanticPlanner& planner, const TPose2D& goal)
    : m_options(options), m_planner(planner), m_check(planner), m_goal(goal) {
  m_options.validate();
}

void DriveGuide::update(const DriveState& state, double z, DriveController& drive, double seconds) {
  auto path = next({state, drive.tracker(), drive.track(), z, seconds, drive.stoppedFor(seconds)});
  if (path) drive.setPath(std::move(*path));
  if (m_target == Target::None) drive.setPath({});
}

bool DriveGuide::isNearGoal(const DriveState& state) const {
  return m_target == Target::Goal && distance(state.pose, m_goal) < m_options.atGoal;
}

bool DriveGuide::arrived(const DriveState& state, const DriveController& drive) const {
  return isNearGoal(state) && !drive.tracker().path().empty() && drive.tracker().finished() &&
         std::abs(state.speed) < kAtRest;
}

ObstacleOptions DriveGuide::obstacles(ObstacleOptions usual) const {
  if (m_target == Target::WayOut) usual.forbiddenGround = false;
  return usual;
}

/** Another path than before, from where the vehicle is; or nothing if it is to go on. */
std::optional<DrivePath> DriveGuide::next(const Situation& now) {
  if (mustChange(now)) return choose(now);
  if (m_target == Target::Back) return {};
  if (now.seconds - m_plannedAt < m_options.period || m_blockedSince >= 0) return {};
  return improve(now);
}

/** The path is at its end, or was in the way of something for long. */
bool DriveGuide::mustChange(const Situation& now) {
  if (now.tracker.finished()) return now.tracker.path().empty() || !isNearGoal(now.state);
  if (m_target == Target::Back) return isStuck(now);
  if (m_target == Target::WayOut && !m_blindOut)
    return isStuck(now) || m_planner.check(now.state.pose, now.z) == PlanStatus::Found;
  const bool blocked = isBlocked(now);
  if (!blocked) m_blockedSince = -1;
  if (blocked && m_blockedSince < 0) m_blockedSince = now.seconds;
  if (blocked && now.seconds - m_blockedSince >= m_options.patience) return true;
  return isStuck(now);
}

bool DriveGuide::isStuck(const Situation& now) const {
  return now.stoppedFor >= 2 * m_options.patience &&
         now.seconds - m_plannedAt >= m_options.patience;
}

bool DriveGuide::isBlocked(const Situation& now) {
  return !m_check.judge(now.tracker.path(), now.tracker.progress()).isFree();
}

/** \param anew from where the vehicle is, whatever its path */
DriveGuide::Departure DriveGuide::departureOf(const Situation& now, bool anew) const {
  if (anew || now.tracker.finished()) return {now.state.pose, now.z, {}};
  const DrivePath& path = now.tracker.path();
  const double here = now.tracker.progress();
  const double ahead = std::max(0.5, std::abs(now.state.speed));  // a second
  const double there = std::min(path.stretchEnd(here), here + ahead);
  return {poseOf(path.at(there)), path.at(there).z, path.part(here, there)};
}

/** The present path as far as the vehicle needs to come to rest: another one begins with a vehicle
 * that stands, and may begin backwards. */
DrivePath DriveGuide::untilRest(const Situation& now) {
  constexpr double kBraking = 0.6, kMore = 0.1;  // m/s^2: less than DriveTracker's; m
  const DrivePath& path = now.tracker.path();
  const double here = now.tracker.progress(), speed = now.state.speed;
  const double there = here + speed * speed / (2 * kBraking) + kMore;
  return path.part(here, std::min(there, path.stretchEnd(here)));
}

std::optional<DrivePath> DriveGuide::choose(const Situation& now) {
  if (!now.tracker.finished() && std::abs(now.state.speed) > kSlow) {
    m_leaving = true;
    return untilRest(now);
  }
  m_plannedAt = now.seconds;
  if (m_planner.check(now.state.pose, now.z) != PlanStatus::Found) return wayOut(now, 0);
  const bool before = std::exchange(m_leaving, false) || !now.tracker.finished();
  const Departure here = departureOf(now, true);
  std::optional<DrivePath> path = toGoal(here);
  if (path)
    take(Target::Goal, now);
  else if ((path = toFrontier(here)))
    take(Target::Frontier, now);
  else if (m_target == Target::None && m_plannedPaths == 0 && !(m_enclosed && m_blindOut))
    return wayOut(now, kBlind);
  else if (!m_enclosed)
    return goBack(now);
  else
    fail(now);
  if (path && before) ++m_replans;
  return path;
}

/** \param nearest 0, or, where the vehicle does not see what it stands on, how far it is blind */
std::optional<DrivePath> DriveGuide::wayOut(const Situation& now, double nearest) {
  DrivePath path = findWayOut(m_planner, now.state.pose, now.z, 8, nearest);
  m_blindOut = nearest > 0;
  if (path.empty()) {
    if (!m_blindOut) m_reason = "the vehicle is where it must not be, and finds no way out";
    return goBack(now);
  }
  take(Target::WayOut, now);
  return path;
}

/** Along the vehicle's own track to where it can plan, and a little on: what is close to it may be
 * out of its sensors' sight, and left nobody knows where. */
std::optional<DrivePath> DriveGuide::goBack(const Situation& now) {
  std::vector<PathPoint> points = now.track.back();
  double z = now.z;
  for (PathPoint& p : points) {
    const auto ground = m_planner.ground().find(p.x, p.y, z);
    if (ground) z = m_planner.ground().centerOf(ground->surface.z);
    p.z = z;
  }
  const DrivePath track(std::move(points));
  constexpr double kStep = 0.2;  // m
  for (double s = kStep; s < track.length() && m_timesBack < kTimesBack; s += kStep) {
    const PathPoint p = track.at(s);
    if (m_planner.check(poseOf(p), p.z) != PlanStatus::Found) continue;
    ++m_timesBack;
    take(Target::Back, now);
    return track.part(0, std::min(track.length(), s + kBackBy));
  }
  fail(now);
  return {};
}

std::optional<DrivePath> DriveGuide::toGoal(const Departure& from) {
  PlanResult plan =
      m_planned ? m_planner.replan(from.pose, from.z) : m_planner.plan(from.pose, m_goal, from.z);
  m_planned = m_planner.hasRoadmap();
  if (!plan.found()) {
    m_reason = plan.reason;
    return {};
  }
  DrivePath path(plan.path);
  m_plan = std::move(plan);
  return path;
}

std::optional<DrivePath> DriveGuide::toFrontier(const Departure& from) {
  std::vector<TPose2D> tried;
  std::optional<DrivePath> path;
  const Exploration places = findFrontiers(m_planner, from.pose, from.z, m_goal, m_seen);
  m_enclosed = places.enclosed;
  if (m_enclosed) m_reason = reasonOf(places);
  for (const Frontier& f : places.frontiers) {
    m_planned = false;
    PlanResult plan = m_planner.plan(from.pose, f.pose, from.z, f.z);
    tried.push_back(f.pose);  // if it is not seen from there, it is not seen
    if (!plan.found() || plan.length < 0.5) continue;
    path.emplace(plan.path);
    m_plan = std::move(plan);
    break;
  }
  // If there is no way to any, it may be for where the vehicle stands.
  if (path || m_timesBack >= kTimesBack) m_seen.insert(m_seen.end(), tried.begin(), tried.end());
  return path;
}

std::optional<DrivePath> DriveGuide::improve(const Situation& now) {
  m_plannedAt = now.seconds;
  const DrivePath& path = now.tracker.path();
  const double here = now.tracker.progress();
  const Departure from = departureOf(now, false);
  if (m_planner.check(from.pose, from.z) != PlanStatus::Found) return {};
  const bool exploring = m_target == Target::Frontier;
  if (exploring && m_planner.check(m_goal) != PlanStatus::Found &&
      path.length() - here > kNearFrontier)
    return {};
  std::optional<DrivePath> then = toGoal(from);
  const bool toGoalNow = then.has_value();
  if (!then && exploring && path.length() - here <= kNearFrontier) then = toFrontier(from);
  if (!then || then->empty()) return {};
  DrivePath better = from.before.empty() ? *then : from.before.part(0, from.before.length(), *then);
  if (!exploring && !m_check.judge(better, 0).isClearlyBetterThan(m_check.judge(path, here)))
    return {};
  take(toGoalNow ? Target::Goal : Target::Frontier, now);
  if (!exploring) ++m_replans;
  return better;
}

void DriveGuide::take(Target target, const Situation& now) {
  if (target == Target::Goal || target == Target::Frontier) ++m_plannedPaths, m_timesBack = 0;
  m_target = target;
  m_plannedAt = now.seconds;
  m_blockedSince = m_withoutSince = -1;
}

void DriveGuide::fail(const Situation& now) {
  m_target = Target::None;
  if (m_withoutSince < 0) m_withoutSince = now.seconds;
  if (m_gaveUp || now.seconds - m_withoutSince < m_options.giveUpAfter) return;
  m_gaveUp = true;
  if (explored() > 0) m_reason += "; frontiers explored: " + std::to_string(explored());
}

}  // namespace semantic_driving
