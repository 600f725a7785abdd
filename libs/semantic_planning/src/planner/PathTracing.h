#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/Roadmap.h>

namespace semantic_planning {

/** The poses along a path of the roadmap, with their arc lengths. */
std::vector<PathPoint> tracePath(const colored_graph::PathResult& path, const Roadmap& roadmap,
                                 const CollisionChecker& checker);

/** Appends a curve's points to a path; the first is where the last one ended, perhaps in another
 * gear. */
void appendCurve(const std::vector<PathPoint>& curve, std::vector<PathPoint>& path);

/** Few places tell most curves that do not fit, sooner than profiles do. \param z of the ground,
 * meters */
bool mayFit(const ReedsSheppCurve& curve, double z, const CollisionChecker& checker);

/** Cost and lengths of a path that was found. */
void setLengths(const colored_graph::PathResult& path, PlanResult& result);

/** Lengths, cost and poses of a search's result, or why there is none. */
void describePath(const colored_graph::PathResult& path, const Roadmap& roadmap,
                  const CollisionChecker& checker, PlanResult& result);

}  // namespace semantic_planning
