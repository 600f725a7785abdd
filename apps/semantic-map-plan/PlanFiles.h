#pragma once
#include <semantic_octree/ClassTable.h>
#include <semantic_planning/PlanResult.h>

#include <colored_graph/ClassOrder.h>
#include <nlohmann/json.hpp>
#include <string>

namespace semantic_map_plan {

/** Name of a ground's class. */
std::string groundName(semantic_octree::ClassId id, const semantic_octree::ClassTable& classes);

/** One line a pose: x,y,z,heading,curvature,gear,class,arc_length. Meters, degrees, 1/m. */
std::string toCsv(const semantic_planning::PlanResult& plan,
                  const semantic_octree::ClassTable& classes);

nlohmann::json toJson(const semantic_planning::PlanResult& plan,
                      const colored_graph::ClassOrder& order,
                      const semantic_octree::ClassTable& classes);

}  // namespace semantic_map_plan
