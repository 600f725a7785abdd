#include "PlanPicture.h"

#include <semantic_types/ClassTable.h>

namespace semantic_map_plan {

using namespace semantic_planning;
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
      canvas.fillSquare({ground.centerOf(c.x), ground.centerOf(c.y)}, ground.voxelSize(),
                        colorOf(s->classId, classes));
      unlabeled |= s->classId == semantic_types::kNoClass;
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

void drawEnd(MapCanvas& canvas, const std::string& name, const TPose2D& pose, const Arrow& arrow) {
  canvas.drawPose(pose, arrow);
  canvas.explain({name, arrow});
}

}  // namespace

cv::Mat drawPlan(MapCanvas canvas, const SemanticPlanner& planner, const PlanResult& plan,
                 const TPose2D& start, const TPose2D& goal) {
  const Ground& ground = planner.ground();
  bool unlabeled = false;
  // What hangs over the ground stays visible, too.
  canvas.drawThrough(kGroundShare,
                     [&] { unlabeled = drawGround(canvas, ground, ground.map().classes()); });
  if (unlabeled) canvas.explain({"ground without a class", semantic_types::kColorWithoutClass});
  drawHoles(canvas, ground);
  if (planner.hasRoadmap()) drawGraph(canvas, planner.roadmap());
  if (plan.found()) drawPath(canvas, plan);
  drawEnd(canvas, "start", start, kStart);
  drawEnd(canvas, "goal", goal, kGoal);
  for (const TPose2D& pose : {start, goal})
    drawFootprint(canvas, planner.options().vehicle.footprint, pose);
  canvas.explain({"footprint", kFootprint});
  if (plan.obstacle) drawInTheWay(canvas, *plan.obstacle);
  return canvas.sheet("plan");
}

}  // namespace semantic_map_plan
