#include "PlanFiles.h"

#include <mrpt_compat/Drawing.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/roadmap/MrptGraph.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace semantic_map_plan {

using namespace semantic_planning;

namespace {

constexpr double kAboveGround = 0.3;  // m, so that the ground does not hide lines

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

void saveScene(const semantic_octree::SemanticOcTree* map, const PlanResult& plan,
               const std::filesystem::path& file) {
  mrpt_compat::Scene scene;
  if (map) {
    auto cells = mrpt_compat::drawing::CSetOfObjects::Create();
    semantic_map::CSemanticOctoMap(*map).getVisualizationInto(*cells);
    scene.insert(cells);
  }
  scene.insert(lineOf(plan));
  semantic_map::writeScene(scene, file);
}

using colored_graph::EdgeState;
using map_pictures::Arrow;
using map_pictures::MapCanvas;
using map_pictures::Stroke;
using mrpt::math::TPose2D;

namespace {

constexpr double kGroundShare = 0.75, kGraphShare = 0.45;
constexpr Stroke kForward{{20, 20, 20}, 3, 2}, kBackward{{230, 159, 0}, 3, 2},
    kUsable{{20, 60, 90}, 1, 0}, kNotEvaluated{{140, 170, 200}, 1, 0};
constexpr Arrow kStart{{0, 160, 60}, 26, 2}, kGoal{{220, 30, 30}, 26, 2},
    kVertex{{0, 40, 90}, 7, 0};
constexpr Stroke kFootprint{{20, 20, 20}, 1, 1}, kInTheWay{{200, 0, 200}, 3, 2};
constexpr map_pictures::Color kHole{214, 204, 226};
constexpr map_pictures::Color kUnlabeledGround{198, 222, 222};  // unlike things without a class

/** \return whether some of it is of no class */
bool drawGround(MapCanvas& canvas, const Ground& ground,
                const semantic_types::ClassTable& classes) {
  bool unlabeled = false;
  for (const Column& tile : ground.tiles())
    for (int i = 0; i < kTileColumns; ++i) {
      const Column first = firstColumnOf(tile);
      const Column c{first.x + i % kTileEdge, first.y + i / kTileEdge};
      const SurfaceRange surfaces = ground.surfaces(c);
      const Surface* s = surfaces.first;
      if (surfaces.empty() || !s->drivable || s->clearance2 == 0) continue;
      const bool isUnlabeled = s->classId == semantic_types::kNoClass;
      canvas.fillSquare({ground.centerOf(c.x), ground.centerOf(c.y)}, ground.voxelSize(),
                        isUnlabeled ? kUnlabeledGround : colorOf(s->classId, classes));
      unlabeled |= isUnlabeled;
    }
  return unlabeled;
}

bool isBesideGround(const Ground& ground, Column c) {
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      for (const Surface& s : ground.surfaces({x, y}))
        if (s.drivable) return true;
  return false;
}

/** Columns of which nothing is known, next to ground that could be driven upon. */
void drawHoles(MapCanvas& canvas, const Ground& ground) {
  bool drawn = false;
  for (const Column& tile : ground.tiles())
    for (int i = 0; i < kTileColumns; ++i) {
      const Column first = firstColumnOf(tile);
      const Column c{first.x + i % kTileEdge, first.y + i / kTileEdge};
      if (!ground.surfaces(c).empty() || !isBesideGround(ground, c)) continue;
      canvas.fillSquare({ground.centerOf(c.x), ground.centerOf(c.y)}, ground.voxelSize(), kHole);
      drawn = true;
    }
  if (drawn) canvas.explain({"ground not known", kHole});
}

void drawCurve(MapCanvas& canvas, const ReedsSheppCurve& curve, const Stroke& stroke) {
  constexpr double kPixels = 4;
  std::vector<Eigen::Vector2d> line;
  const int pieces = 1 + static_cast<int>(curve.length() * canvas.pixelsPerMeter() / kPixels);
  for (int i = 0; i <= pieces; ++i) {
    const TPose2D p = curve.at(curve.length() * i / pieces).pose;
    line.emplace_back(p.x, p.y);
  }
  canvas.drawLine(line, stroke);
}

/** All but the blocked edges. */
void drawEdges(MapCanvas& canvas, const Roadmap& roadmap) {
  const auto& graph = roadmap.graph();
  for (colored_graph::EdgeId e = 0; e < graph.edgeIdEnd(); ++e)
    if (graph.containsEdge(e) && graph.edge(e).state != EdgeState::Blocked)
      drawCurve(canvas, roadmap.curve(e, graph.edge(e).a),
                graph.edge(e).state == EdgeState::Usable ? kUsable : kNotEvaluated);
}

void drawGraph(MapCanvas& canvas, const Roadmap& roadmap) {
  canvas.drawThrough(kGraphShare, [&] { drawEdges(canvas, roadmap); });
  for (colored_graph::VertexId v = 0; v < roadmap.graph().vertexIdEnd(); ++v)
    if (roadmap.graph().containsVertex(v)) canvas.drawPose(roadmap.pose(v).pose, kVertex);
  canvas.explain({"vertex", kVertex});
  canvas.explain({"edge", kUsable});
  canvas.explain({"edge, not evaluated", kNotEvaluated});
}

/** Stretch by stretch; a point's gear is that of the way to it. */
void drawPath(MapCanvas& canvas, const PlanResult& plan) {
  bool drawn[2] = {false, false};
  const auto& path = plan.path;
  for (std::size_t begin = 0; begin + 1 < path.size();) {
    const bool forward = path[begin + 1].forward;
    std::vector<Eigen::Vector2d> line = {{path[begin].x, path[begin].y}};
    while (begin + 1 < path.size() && path[begin + 1].forward == forward) {
      ++begin;
      line.emplace_back(path[begin].x, path[begin].y);
    }
    canvas.drawLine(line, forward ? kForward : kBackward);
    drawn[forward] = true;
  }
  if (drawn[true]) canvas.explain({"path, forward", kForward});
  if (drawn[false]) canvas.explain({"path, backward", kBackward});
}

void drawFootprint(MapCanvas& canvas, const Footprint& footprint, const TPose2D& pose) {
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i <= footprint.size(); ++i) {
    const Eigen::Vector2d& corner = footprint[i % footprint.size()];
    const auto at = pose.composePoint({corner.x(), corner.y()});
    outline.emplace_back(at.x, at.y);
  }
  canvas.drawLine(outline, kFootprint);
}

/** A cross. */
void drawInTheWay(MapCanvas& canvas, const mrpt::math::TPoint2D& place) {
  const double arm = 7 / canvas.pixelsPerMeter();
  canvas.drawLine({{place.x - arm, place.y - arm}, {place.x + arm, place.y + arm}}, kInTheWay);
  canvas.drawLine({{place.x - arm, place.y + arm}, {place.x + arm, place.y - arm}}, kInTheWay);
  canvas.explain({"in the way", kInTheWay});
}

}  // namespace

cv::Mat drawPlan(MapCanvas canvas, const SemanticPlanner& planner, const PlanResult& plan,
                 const TPose2D& start, const TPose2D& goal) {
  const Ground& ground = planner.ground();
  bool unlabeled = false;
  // What hangs over the ground stays visible, too.
  canvas.drawThrough(kGroundShare,
                     [&] { unlabeled = drawGround(canvas, ground, ground.map().classes()); });
  if (unlabeled) canvas.explain({"ground without a class", kUnlabeledGround});
  drawHoles(canvas, ground);
  if (planner.hasRoadmap()) drawGraph(canvas, planner.roadmap());
  if (plan.found()) drawPath(canvas, plan);
  canvas.drawPose(start, kStart, "start");
  canvas.drawPose(goal, kGoal, "goal");
  for (const TPose2D& pose : {start, goal})
    drawFootprint(canvas, planner.options().vehicle.footprint, pose);
  canvas.explain({"footprint", kFootprint});
  if (plan.obstacle) drawInTheWay(canvas, *plan.obstacle);
  return canvas.sheet("plan");
}

using nlohmann::json;
using semantic_types::ClassTable;

namespace {

json lengthsByName(const PlanResult& plan, const ClassTable& classes) {
  json lengths = json::object();
  for (std::size_t id = 0; id < plan.lengthPerClass.size(); ++id)
    if (plan.lengthPerClass[id] > 0)
      lengths[groundName(static_cast<semantic_types::ClassId>(id), classes)] =
          plan.lengthPerClass[id];
  return lengths;
}

/** The classes of each rank, best first. */
json ranksOf(const colored_graph::ClassOrder& order, const ClassTable& classes) {
  json ranks = json::array();
  for (int rank = 0; rank < order.ranks(); ++rank) {
    json names = json::array();
    for (int id = 0; id < order.classes(); ++id)
      if (order.rank(static_cast<colored_graph::GraphClass>(id)) == rank)
        names.push_back(groundName(static_cast<semantic_types::ClassId>(id), classes));
    ranks.push_back(names);
  }
  return ranks;
}

json timesOf(const semantic_planning::StageTimes& times) {
  json stages = json::object();
  for (const auto& [stage, milliseconds] : times) stages[stage] = milliseconds;
  return stages;
}

}  // namespace

std::string groundName(semantic_types::ClassId id, const ClassTable& classes) {
  return id == semantic_types::kNoClass ? semantic_planning::kUnknownGround : classes.name(id);
}

std::string toCsv(const PlanResult& plan, const ClassTable& classes) {
  std::ostringstream out;
  out << "x,y,z,heading,curvature,gear,class,arc_length\n" << std::fixed << std::setprecision(4);
  for (const PathPoint& p : plan.path)
    out << p.x << ',' << p.y << ',' << p.z << ',' << p.heading * 180 / M_PI << ',' << p.curvature
        << ',' << (p.forward ? "forward" : "backward") << ','
        << strict_files::csvField(groundName(p.classId, classes)) << ',' << p.arcLength << '\n';
  return out.str();
}

json toJson(const PlanResult& plan, const colored_graph::ClassOrder& order,
            const ClassTable& classes) {
  return {{"status", nameOf(plan.status)},
          {"reason", plan.reason},
          {"cost", plan.cost},
          {"price", plan.price},
          {"graphCost", plan.numVertices > 0 ? plan.cost : std::vector<std::int64_t>()},
          {"ranks", ranksOf(order, classes)},
          {"length", plan.length},
          {"lengthPerClass", lengthsByName(plan, classes)},
          {"vertices", plan.numVertices},
          {"edges", plan.numEdges},
          {"edgesEvaluated", plan.search.edgesEvaluated},
          {"expansions", plan.search.expansions},
          {"milliseconds", timesOf(plan.times)}};
}

void saveNetwork(const semantic_planning::Roadmap& roadmap, const ClassTable& classes,
                 const std::filesystem::path& file) {
  std::vector<std::string> names;
  for (int id = 0; id <= classes.size(); ++id)
    names.push_back(groundName(static_cast<semantic_types::ClassId>(id), classes));
  std::ostringstream out;
  out << std::setprecision(10);
  toNetwork(roadmap, names).writeAsText(out);
  strict_files::writeText(file, out.str());
}

}  // namespace semantic_map_plan
