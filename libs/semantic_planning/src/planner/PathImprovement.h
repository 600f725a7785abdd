#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/EdgeChecker.h>

namespace semantic_planning {

struct ImprovementOptions {
  double reach = 15;          ///< longest curve, meters
  double classTolerance = 0;  ///< meters, see PlannerOptions
};

/** Replaces a path by a better one through poses beside it or beside a guide, if there is one, and
 * a missing path by one beside the guide: less way through classes worse than the best, or, where
 * that ties within the tolerance, for a lower DrivePrice. Costs are those of lengths per class
 * (EdgeModel::Profile, CostKind::ArcLength). \param guide as of searchGuide(); may be empty */
void improvePath(PlanResult& result, const std::vector<PathPoint>& guide,
                 const EdgeChecker& checker, const ImprovementOptions& options);

}  // namespace semantic_planning
