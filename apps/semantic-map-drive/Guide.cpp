#include "Guide.h"

#include <semantic_planning/DriveFrontier.h>
#include <semantic_planning/DriveWayOut.h>

#include <algorithm>
#include <cmath>

namespace semantic_map_drive {

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

constexpr double kNearFrontier = 3;  // m: the next one is looked for before the robot stops
constexpr double kBlind = 2;         // m: the sensors do not see the ground nearer than this
constexpr double kAtGoal = 0.3;      // m

double distance(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

const char* nameOf(Guide::Target target) {
  switch (target) {
    case Guide::Target::Goal:
      return "goal";
    case Guide::Target::Frontier:
      return "frontier";
    case Guide::Target::WayOut:
      return "way out";
    default:
      return "none";
  }
}

Guide::Guide(const GuideConfig& config, SemanticPlanner& planner, const TPose2D& goal)
    : m_config(config), m_planner(planner), m_check(planner), m_goal(goal) {}

std::optional<DrivePath> Guide::update(const DriveState& state, double z,
                                       const DriveController& drive, double seconds) {
  const Situation now{state, drive.tracker(), z, seconds};
  if (mustChange(now, drive.stoppedFor(seconds))) return choose(now);
  if (seconds - m_plannedAt < m_config.period || m_blockedSince >= 0) return {};
  return improve(now);
}

/** The path is at its end, or was in the way of something for long. */
bool Guide::mustChange(const Situation& now, double stoppedFor) {
  const bool atGoal = m_target == Target::Goal && distance(now.state.pose, m_goal) < kAtGoal &&
                      !now.tracker.path().empty();
  if (now.tracker.finished()) return !atGoal;
  if (m_target == Target::WayOut && !m_blindOut)
    return m_planner.check(now.state.pose, now.z) == PlanStatus::Found;
  const bool blocked = isBlocked(now);
  if (!blocked) m_blockedSince = -1;
  if (blocked && m_blockedSince < 0) m_blockedSince = now.seconds;
  if (blocked && now.seconds - m_blockedSince >= m_config.patience) return true;
  return stoppedFor >= 2 * m_config.patience && now.seconds - m_plannedAt >= m_config.patience;
}

bool Guide::isBlocked(const Situation& now) {
  return !m_check.judge(now.tracker.path(), now.tracker.progress()).isFree();
}

/** \param anew from where the robot is, whatever its path */
Guide::Departure Guide::departureOf(const Situation& now, bool anew) const {
  if (anew || now.tracker.finished()) return {now.state.pose, now.z, {}};
  const DrivePath& path = now.tracker.path();
  const double here = now.tracker.progress();
  const double ahead = std::max(0.5, std::abs(now.state.speed));  // a second
  const double there = std::min(path.stretchEnd(here), here + ahead);
  return {poseOf(path.at(there)), path.at(there).z, path.part(here, there)};
}

std::optional<DrivePath> Guide::choose(const Situation& now) {
  m_plannedAt = now.seconds;
  if (m_planner.check(now.state.pose, now.z) != PlanStatus::Found) return wayOut(now, 0);
  const bool before = !now.tracker.finished();
  const Departure here = departureOf(now, true);
  std::optional<DrivePath> path = toGoal(here);
  if (path)
    take(Target::Goal, now);
  else if ((path = toFrontier(here)))
    take(Target::Frontier, now);
  else if (m_target == Target::None && m_plannedPaths == 0)
    return wayOut(now, kBlind);
  else
    fail(now);
  if (path && before) ++m_replans;
  return path;
}

/** \param nearest 0, or, where the robot does not see what it stands on, how far it is blind */
std::optional<DrivePath> Guide::wayOut(const Situation& now, double nearest) {
  DrivePath path = findWayOut(m_planner, now.state.pose, now.z, 8, nearest);
  m_blindOut = nearest > 0;
  if (path.empty()) {
    if (!m_blindOut) m_reason = "the robot is where it must not be, and finds no way out";
    fail(now);
    return {};
  }
  take(Target::WayOut, now);
  return path;
}

std::optional<DrivePath> Guide::toGoal(const Departure& from) {
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

std::optional<DrivePath> Guide::toFrontier(const Departure& from) {
  for (const Frontier& f : findFrontiers(m_planner, from.pose, from.z, m_goal, m_seen)) {
    m_planned = false;
    PlanResult plan = m_planner.plan(from.pose, f.pose, from.z, f.z);
    m_seen.push_back(f.pose);  // if it is not seen from there, it is not seen
    if (!plan.found() || plan.length < 0.5) continue;
    DrivePath path(plan.path);
    m_plan = std::move(plan);
    return path;
  }
  return {};
}

std::optional<DrivePath> Guide::improve(const Situation& now) {
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

void Guide::take(Target target, const Situation& now) {
  if (target != Target::WayOut) ++m_plannedPaths;
  m_target = target;
  m_plannedAt = now.seconds;
  m_blockedSince = m_withoutSince = -1;
}

void Guide::fail(const Situation& now) {
  m_target = Target::None;
  if (m_withoutSince < 0) m_withoutSince = now.seconds;
  m_gaveUp = now.seconds - m_withoutSince >= m_config.giveUpAfter;
}

}  // namespace semantic_map_drive
