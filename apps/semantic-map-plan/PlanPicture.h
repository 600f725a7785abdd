#pragma once
#include <map_pictures/MapCanvas.h>
#include <semantic_planning/planner/SemanticPlanner.h>

namespace semantic_map_plan {

/** Draws upon the map from above the drivable ground in its classes' colors and the holes in it,
 * the graph's vertices and its edges (light: not evaluated; blocked ones are left out), start and
 * goal as arrows with the footprint, the path if there is one, what is in the way of a start or
 * goal that is refused, and a legend of all that. */
cv::Mat drawPlan(map_pictures::MapCanvas canvas, const semantic_planning::SemanticPlanner& planner,
                 const semantic_planning::PlanResult& plan, const mrpt::math::TPose2D& start,
                 const mrpt::math::TPose2D& goal);

}  // namespace semantic_map_plan
