#pragma once
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/roadmap/Roadmap.h>
#include <semantic_types/ClassTable.h>

#include <colored_graph/ClassOrder.h>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace semantic_map_plan {

/** Name of a ground's class. */
std::string groundName(semantic_types::ClassId id, const semantic_types::ClassTable& classes);

/** One line a pose: x,y,z,heading,curvature,gear,class,arc_length. Meters, degrees, 1/m. */
std::string toCsv(const semantic_planning::PlanResult& plan,
                  const semantic_types::ClassTable& classes);

nlohmann::json toJson(const semantic_planning::PlanResult& plan,
                      const colored_graph::ClassOrder& order,
                      const semantic_types::ClassTable& classes);

/** As MRPT's .graph file. */
void saveNetwork(const semantic_planning::Roadmap& roadmap,
                 const semantic_types::ClassTable& classes, const std::filesystem::path& file);

}  // namespace semantic_map_plan
