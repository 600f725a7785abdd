#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>
#include <opencv2/core.hpp>

namespace semantic_map_plan {

/** The map from above with the drivable ground in its classes' colors, the graph's edges thin and
 * in the color of their longest class (dashes of gray: not evaluated; red: blocked), start and goal
 * as arrows, and the path, if there is one. */
cv::Mat drawPlan(const semantic_octree::SemanticOcTree& map,
                 const semantic_planning::SemanticPlanner& planner,
                 const semantic_planning::PlanResult& plan, const mrpt::math::TPose2D& start,
                 const mrpt::math::TPose2D& goal);

}  // namespace semantic_map_plan
