#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>
#include <opencv2/core.hpp>

namespace semantic_map_plan {

/** The map from above with the drivable ground in its classes' colors, the graph's vertices and its
 * edges (light: not evaluated; blocked ones are left out), start and goal as arrows, the path if
 * there is one, and a legend of all that. */
cv::Mat drawPlan(const semantic_octree::SemanticOcTree& map,
                 const semantic_planning::SemanticPlanner& planner,
                 const semantic_planning::PlanResult& plan, const mrpt::math::TPose2D& start,
                 const mrpt::math::TPose2D& goal);

}  // namespace semantic_map_plan
