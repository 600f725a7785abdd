#pragma once
#include <colored_graph/ClassOrder.h>
#include <map_pictures/MapCanvas.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <semantic_planning/roadmap/Roadmap.h>
#include <semantic_types/ClassTable.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace semantic_map_plan {

/** Writes a scene for MRPT's SceneViewer3D: the map and the path.
 * \param map null: it is left out, as one that may be larger than memory has to be
 * \throw std::runtime_error naming the file. */
void saveScene(const semantic_octree::SemanticOcTree* map,
               const semantic_planning::PlanResult& plan, const std::filesystem::path& file);

/** Draws a plan upon the map from above, with a legend. It shows drivable ground in its classes'
 * colors, its holes, the graph and the path. Start and goal are arrows with the footprint, with
 * what refuses them. Light edges are not evaluated, blocked ones are left out. */
cv::Mat drawPlan(map_pictures::MapCanvas canvas, const semantic_planning::SemanticPlanner& planner,
                 const semantic_planning::PlanResult& plan, const mrpt::math::TPose2D& start,
                 const mrpt::math::TPose2D& goal);

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
