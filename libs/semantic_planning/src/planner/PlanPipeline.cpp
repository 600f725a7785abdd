#include "PathImprovement.h"
#include "PlannerCore.h"

namespace semantic_planning {

namespace {

/** What a path may cost before a roadmap is tried: turning takes some meters at both ends. */
double mostOf(const RelaxedPath& relaxed) {
  constexpr double kShare = 1.2, kTurns = 20;  // m
  return kShare * relaxed.price + kTurns;
}

}  // namespace

/** From the price field to a path:
 * 1. the way of least price of a vehicle that turns on the spot,
 * 2. beside it the best path that the vehicle can drive, which is smoothed,
 * 3. if there is none, or one that costs much more than that way: the roadmap's, improved alike. */
PlanResult PlannerCore::solve(StageClock& clock) {
  if (!mayShorten()) return searchRoadmap(clock);
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
  if (mayShorten()) rest = m_kept.restFrom(*m_startPose);
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
  PlanResult result = beside(relaxed.path, {});
  clock.end("beside");
  if (result.found() && result.price <= mostOf(relaxed)) {
    m_search->forget();  // first: it refers to the roadmap's graph
    m_roadmap.reset();
    return result;
  }
  PlanResult other = searchRoadmap(clock);
  if (other.path.size() > 2) {
    PlanResult improved = beside(other.path, other);
    if (improved.found()) other = std::move(improved);
    clock.end("shorten");
  }
  if (!result.found() || (other.found() && other.price < result.price)) result = std::move(other);
  if (!result.found()) sayWhere(relaxed, result);
  return result;
}

}  // namespace semantic_planning
