#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <filesystem>

namespace semantic_map_plan {

/** Writes a scene for MRPT's SceneViewer3D: the map, the roadmap's vertices, and the path.
 * \param map null: it is left out, as one that may be larger than memory has to be
 * \throw std::runtime_error naming the file. */
void saveScene(const semantic_octree::SemanticOcTree* map,
               const semantic_planning::SemanticPlanner& planner,
               const semantic_planning::PlanResult& plan, const std::filesystem::path& file);

}  // namespace semantic_map_plan
