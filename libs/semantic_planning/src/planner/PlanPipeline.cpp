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
 *    alike,
 * 4. if none is good yet, and classes come before length: beside the roadmap's path. The way that
 *    turns on the spot may slip over a strip of a voxel, and no price leads around it. */
PlanResult PlannerCore::pathBy(const RelaxedPath& relaxed, const Task& task, StageClock& clock) {
  const CollisionChecker& checker = task.checker;
  PlanResult result = pathBeside(relaxed.path, false, checker, m_prices);
  clock.end("beside");
  const auto isGood = [&] { return result.found() && result.price <= mostOf(relaxed); };
  const auto offer = [&](const std::vector<PathPoint>& way) {
    PlanResult other = pathBeside(way, true, checker, m_prices);
    if (!result.found() || (other.found() && other.price < result.price)) result = std::move(other);
    clock.end("way");
  };
  if (isGood()) return result;
  if (isCancelled()) return cancelledPlan();
  offer(wayBetween(task.start, task.goal, checker, m_prices));
  if (m_options.strict && !isGood()) offer(searchRoadmap(clock).path);
  return result.found() ? result : noPath(relaxed, task);
}

/** What is left of a path stays if nothing costs clearly less. */
PlannerCore::Solution PlannerCore::solve(const Task& task, StageClock& clock) {
  if (needsRoadmap(m_options)) return {searchRoadmap(clock), {}};
  if (isCancelled() && !task.rest) return {cancelledPlan(), {}};
  // Where the ground does not connect them, that is known before any other search.
  const RelaxedPath relaxed = searchRelaxed(task.checker, task.start, task.goal);
  clock.end("relaxed");
  if (task.rest && !m_kept.mayBeBeaten(*task.rest, relaxed.price)) return {*task.rest, {}};
  PlanResult result = pathBy(relaxed, task, clock);
  if (task.rest && (!result.found() || task.rest->price <= result.price)) result = *task.rest;
  return {std::move(result), relaxed.price};
}

PlanResult PlannerCore::take(Solution solution, StageClock& clock) {
  if (solution.least) {
    m_kept.drop();
    if (solution.plan.found()) m_kept.keep(solution.plan, *solution.least);
  }
  solution.plan.times = clock.take();
  return std::move(solution.plan);
}

}  // namespace semantic_planning
