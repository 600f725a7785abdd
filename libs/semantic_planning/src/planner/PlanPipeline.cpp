#include "PathImprovement.h"
#include "PlannerCore.h"
#include "PoseSearch.h"

namespace semantic_planning {

namespace {

/** What a path may cost before another way is looked for: turning takes some meters at both ends.
 */
double mostOf(const RelaxedPath& relaxed) {
  constexpr double kShare = 1.2, kTurns = 20;  // m
  return kShare * relaxed.price + kTurns;
}

PlanResult cancelledPlan() {
  PlanResult result;
  result.status = PlanStatus::Cancelled;
  result.reason = describe(colored_graph::SearchStatus::Cancelled);
  return result;
}

}  // namespace

/** From the price field to a path:
 * 1. the way of least price of a vehicle that turns on the spot,
 * 2. beside it the best path that the vehicle can drive, which is smoothed,
 * 3. if there is none, or one that costs much more than that way: from pose to pose, improved
 *    alike. Where classes come before length, the roadmap's path takes its place: the way that
 * turns on the spot may slip over a strip of a voxel, and no price leads around it. */
PlanResult PlannerCore::solve(StageClock& clock) {
  if (needsRoadmap(m_options)) return searchRoadmap(clock);
  if (isCancelled()) return cancelledPlan();
  const RelaxedPath relaxed = relaxedPath();
  clock.end("relaxed");
  const PlanResult result = solve(relaxed, clock);
  m_kept.drop();
  if (result.found()) m_kept.keep(result, relaxed.price);
  return result;
}

/** No search at all if the vehicle is on a path that is free and nothing can cost clearly less. */
PlanResult PlannerCore::keepOrSolve(StageClock& clock) {
  std::optional<PlanResult> rest;
  if (!needsRoadmap(m_options)) rest = m_kept.restFrom(*m_startPose);
  if (!rest) return solve(clock);
  if (m_kept.isOfThisGround()) return *rest;
  const RelaxedPath relaxed = relaxedPath();
  clock.end("relaxed");
  if (!m_kept.mayBeBeaten(*rest, relaxed.price)) return *rest;
  PlanResult other = solve(relaxed, clock);
  if (!other.found() || rest->price <= other.price) other = std::move(*rest);
  m_kept.keep(other, relaxed.price);
  return other;
}

PlanResult PlannerCore::solve(const RelaxedPath& relaxed, StageClock& clock) {
  PlanResult result = pathBeside(relaxed.path, false, m_checker, m_prices);
  clock.end("beside");
  if (result.found() && result.price <= mostOf(relaxed)) return result;
  if (isCancelled()) return cancelledPlan();
  const std::vector<PathPoint> way =
      m_options.strict ? searchRoadmap(clock).path
                       : wayBetween(*m_startPose, *m_goalPose, m_checker, m_prices);
  clock.end("way");
  PlanResult other = pathBeside(way, true, m_checker, m_prices);
  clock.end("shorten");
  if (!result.found() || (other.found() && other.price < result.price)) result = std::move(other);
  return result.found() ? result : noPath(relaxed);
}

}  // namespace semantic_planning
