#pragma once
#include <colored_graph/CostModel.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/EdgeChecker.h>

namespace semantic_planning {

/** Replaces a path by a better one through poses of its own, if there is one: detours over the
 * roadmap's vertices become single curves. The search is the roadmap's, over the curves between the
 * path's poses. A path that has as much way through each class worse than the best, but more gear
 * changes, is not better. \param model of lengths per class: EdgeModel::Profile and
 * CostKind::ArcLength \param reach longest curve, meters */
void shortenPath(PlanResult& result, const EdgeChecker& checker,
                 const colored_graph::CostModel& model, double reach);

}  // namespace semantic_planning
