#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include "../semantic_planning/PaintedWorld.h"

/** A planner over a painted world: roads are best, then grass; all else is forbidden.
 * \param clearance of the vehicle, meters */
inline semantic_planning::SemanticPlanner plannerOver(PaintedWorld& world, double clearance = 0.1) {
  semantic_planning::PlannerOptions options;
  options.roadmap.kind = semantic_planning::GraphKind::HaltonDrivable;
  options.vehicle.clearance = clearance;
  return {world.map(), colored_graph::ClassOrder(5, {{1}, {2}, {0}}), options};
}
