#include "PlanPicture.h"

#include <semantic_map/MapPictures.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace semantic_map_plan {

using namespace semantic_planning;
using colored_graph::EdgeState;
using mrpt::math::TPose2D;
using semantic_types::ClassTable;

namespace {

const cv::Scalar kPathColor(20, 20, 20), kPathHalo(255, 255, 255);
const cv::Scalar kStartColor(60, 160, 0), kGoalColor(30, 30, 220);

cv::Scalar colorOf(ClassId id, const ClassTable& classes) {
  if (id == semantic_types::kNoClass) return {190, 190, 190};
  const auto color = classes.color(id);
  return {double(color.b), double(color.g), double(color.r)};
}

class PlanSheet {
 public:
  PlanSheet(const semantic_octree::SemanticOcTree& map, const SemanticPlanner& planner)
      : m_classes(map.classes()), m_planner(planner) {
    semantic_map::PictureStyle style;
    style.title = "plan";
    m_view = takeTopView(map, style);
  }

  /** Lets the ground that can be driven upon shine through what hangs over it. */
  void drawGround() {
    cv::Mat ground = m_view.picture.clone();
    const Ground& g = m_planner.ground();
    const double half = g.voxelSize() / 2;
    for (const Column& tile : g.tiles())
      for (int i = 0; i < kTileColumns; ++i) {
        const Column first = firstColumnOf(tile),
                     c{first.x + i % kTileEdge, first.y + i / kTileEdge};
        const SurfaceRange surfaces = g.surfaces(c);
        const Surface* s = surfaces.first;
        if (surfaces.empty() || !s->drivable || s->clearance2 == 0) continue;
        const double x = g.centerOf(c.x), y = g.centerOf(c.y);
        cv::rectangle(ground, pixel(x - half, y + half), pixel(x + half, y - half),
                      colorOf(s->classId, m_classes), cv::FILLED);
      }
    cv::addWeighted(ground, 0.75, m_view.picture, 0.25, 0, m_view.picture);
  }

  void drawGraph() {
    cv::Mat drawn = m_view.picture.clone();
    const auto& graph = m_planner.roadmap().graph();
    for (colored_graph::EdgeId e = 0; e < graph.edgeIdEnd(); ++e)
      if (graph.containsEdge(e) && graph.edge(e).state != EdgeState::Blocked) drawEdge(drawn, e);
    cv::addWeighted(drawn, 0.45, m_view.picture, 0.55, 0, m_view.picture);
    for (colored_graph::VertexId v = 0; v < graph.vertexIdEnd(); ++v)
      if (graph.containsVertex(v)) drawVertex(v);
  }

  void drawPath(const PlanResult& plan) {
    std::vector<cv::Point> line;
    for (const PathPoint& p : plan.path) line.push_back(pixel(p.x, p.y));
    cv::polylines(m_view.picture, line, false, kPathHalo, 7, cv::LINE_AA);
    cv::polylines(m_view.picture, line, false, kPathColor, 3, cv::LINE_AA);
  }

  void drawEnd(const TPose2D& pose, const cv::Scalar& color) {
    const double length = 22 / m_view.pixelsPerMeter;
    const cv::Point from = pixel(pose.x, pose.y), to = pixel(pose.x + length * std::cos(pose.phi),
                                                             pose.y + length * std::sin(pose.phi));
    cv::circle(m_view.picture, from, 8, kPathHalo, cv::FILLED, cv::LINE_AA);
    cv::circle(m_view.picture, from, 6, color, cv::FILLED, cv::LINE_AA);
    cv::arrowedLine(m_view.picture, from, to, color, 3, cv::LINE_AA, 0, 0.4);
  }

  cv::Mat picture() const { return m_view.picture; }

 private:
  cv::Point pixel(double x, double y) const {
    const cv::Point2d p = m_view.at(x, y);
    return {int(std::lround(p.x)), int(std::lround(p.y))};
  }

  void drawEdge(cv::Mat& on, colored_graph::EdgeId e) {
    const auto& edge = m_planner.roadmap().graph().edge(e);
    const bool known = edge.state == EdgeState::Usable;
    const ReedsSheppCurve curve = m_planner.roadmap().curve(e, edge.a);
    std::vector<cv::Point> line;
    const int pieces = 1 + static_cast<int>(curve.length() * m_view.pixelsPerMeter / 4);
    for (int i = 0; i <= pieces; ++i) {
      const TPose2D p = curve.at(curve.length() * i / pieces).pose;
      line.push_back(pixel(p.x, p.y));
    }
    cv::polylines(on, line, false, known ? cv::Scalar(90, 60, 20) : cv::Scalar(200, 170, 140), 1,
                  cv::LINE_AA);
  }

  void drawVertex(colored_graph::VertexId v) {
    const TPose2D& pose = m_planner.roadmap().pose(v).pose;
    const double length = 6 / m_view.pixelsPerMeter;
    const cv::Point from = pixel(pose.x, pose.y), to = pixel(pose.x + length * std::cos(pose.phi),
                                                             pose.y + length * std::sin(pose.phi));
    cv::circle(m_view.picture, from, 2, {90, 40, 0}, cv::FILLED, cv::LINE_AA);
    cv::line(m_view.picture, from, to, {90, 40, 0}, 1, cv::LINE_AA);
  }

  const ClassTable& m_classes;
  const SemanticPlanner& m_planner;
  semantic_map::TopView m_view;
};

}  // namespace

cv::Mat drawPlan(const semantic_octree::SemanticOcTree& map, const SemanticPlanner& planner,
                 const PlanResult& plan, const TPose2D& start, const TPose2D& goal) {
  PlanSheet sheet(map, planner);
  sheet.drawGround();
  if (planner.hasRoadmap()) sheet.drawGraph();
  if (plan.found()) sheet.drawPath(plan);
  sheet.drawEnd(start, kStartColor);
  sheet.drawEnd(goal, kGoalColor);
  return sheet.picture();
}

}  // namespace semantic_map_plan
