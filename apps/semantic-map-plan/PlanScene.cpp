#include "PlanScene.h"

#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>

namespace semantic_map_plan {

using namespace semantic_planning;

namespace {

constexpr double kAboveGround = 0.3;  // m, so that the ground does not hide lines

mrpt_compat::drawing::CPointCloud::Ptr verticesOf(const SemanticPlanner& planner) {
  auto points = mrpt_compat::drawing::CPointCloud::Create();
  points->setName("vertices");
  points->setPointSize(4);
  points->setColor_u8(0, 40, 90);
  const Roadmap& roadmap = planner.roadmap();
  for (colored_graph::VertexId v = 0; v < roadmap.graph().vertexIdEnd(); ++v)
    if (roadmap.graph().containsVertex(v)) {
      const GroundPose& p = roadmap.pose(v);
      points->insertPoint(p.pose.x, p.pose.y, planner.ground().centerOf(p.z) + kAboveGround);
    }
  return points;
}

mrpt_compat::drawing::CSetOfLines::Ptr lineOf(const PlanResult& plan) {
  auto line = mrpt_compat::drawing::CSetOfLines::Create();
  line->setName("path");
  line->setLineWidth(4);
  line->setColor_u8(20, 20, 20);
  for (std::size_t i = 1; i < plan.path.size(); ++i) {
    const PathPoint &a = plan.path[i - 1], &b = plan.path[i];
    line->appendLine(a.x, a.y, a.z + kAboveGround, b.x, b.y, b.z + kAboveGround);
  }
  return line;
}

}  // namespace

void saveScene(const semantic_octree::SemanticOcTree* map, const SemanticPlanner& planner,
               const PlanResult& plan, const std::filesystem::path& file) {
  mrpt_compat::Scene scene;
  if (map) {
    auto cells = mrpt_compat::drawing::CSetOfObjects::Create();
    semantic_map::CSemanticOctoMap(*map).getVisualizationInto(*cells);
    scene.insert(cells);
  }
  if (planner.hasRoadmap()) scene.insert(verticesOf(planner));
  scene.insert(lineOf(plan));
  semantic_map::writeScene(scene, file);
}

}  // namespace semantic_map_plan
