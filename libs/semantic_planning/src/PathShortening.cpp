#include "PathShortening.h"

#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <cmath>

#include "PathTracing.h"

namespace semantic_planning {

using colored_graph::ColoredGraph;
using colored_graph::VertexId;

namespace {

/** Meters along the path between poses that a curve may start or end at. */
constexpr double kSpacing = 1.0;

/** Poses along the path: its ends, where the gear changes, and between. */
std::vector<GroundPose> stationsOf(const std::vector<PathPoint>& path, const EdgeChecker& checker) {
  std::vector<GroundPose> stations;
  double last = -kSpacing;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathPoint& p = path[i];
    const bool isEnd = i + 1 == path.size();
    const bool changesGear = !isEnd && p.forward != path[i + 1].forward;
    if (!isEnd && !changesGear && p.arcLength < last + kSpacing) continue;
    if (const auto pose = checker.place({p.x, p.y, p.heading}, p.z)) stations.push_back(*pose);
    last = p.arcLength;
  }
  return stations;
}

/** All curves between the stations that are short enough; vertex i is station i. */
ColoredGraph graphOf(const std::vector<GroundPose>& stations, const EdgeChecker& checker,
                     double reach) {
  ColoredGraph graph(checker.order().classes());
  for (const GroundPose& pose : stations) graph.addVertex(checker.classAt(pose));
  for (VertexId b = 1; b < stations.size(); ++b)
    for (VertexId a = 0; a < b; ++a) {
      const auto &from = stations[a].pose, &to = stations[b].pose;
      if (checker.reedsShepp().lowerBound(from, to) > reach) continue;
      const double length = checker.reedsShepp().distance(from, to);
      if (length <= reach || a + 1 == b)
        graph.addUnevaluatedEdge(a, b, colored_graph::lengthDown(length));
    }
  return graph;
}

colored_graph::ColoredAStarOptions searchOptions(const ColoredGraph& graph,
                                                 const std::vector<GroundPose>& stations,
                                                 const EdgeChecker& checker) {
  colored_graph::ColoredAStarOptions options;
  options.lengthBound = [&](VertexId a, VertexId b) {
    const auto &p = stations[a].pose, &q = stations[b].pose;
    return colored_graph::lengthDown(std::hypot(p.x - q.x, p.y - q.y));
  };
  options.evaluate = [&](colored_graph::EdgeId e) {
    const colored_graph::Edge& edge = graph.edge(e);
    return checker.profile(stations[std::min(edge.a, edge.b)], stations[std::max(edge.a, edge.b)]);
  };
  return options;
}

/** \return whether the path became better */
bool shortenOnce(PlanResult& result, const EdgeChecker& checker,
                 const colored_graph::CostModel& model, double reach) {
  const std::vector<GroundPose> stations = stationsOf(result.path, checker);
  ColoredGraph graph = graphOf(stations, checker, reach);
  const auto last = static_cast<VertexId>(stations.size() - 1);
  const auto path = findColoredPath(graph, 0, last, model, searchOptions(graph, stations, checker));
  if (!path.found() || !(path.cost < result.cost)) return false;
  std::vector<PathPoint> points;
  result.vertices.clear();
  for (std::size_t i = 0; i < path.vertices.size(); ++i) {
    const GroundPose& pose = stations[path.vertices[i]];
    result.vertices.push_back(pose.pose);
    if (i + 1 == path.vertices.size()) break;
    const auto& next = stations[path.vertices[i + 1]].pose;
    appendCurve(checker.trace(checker.reedsShepp().connect(pose.pose, next), pose.z), points);
  }
  result.path = std::move(points);
  setLengths(path, result);
  return true;
}

}  // namespace

void shortenPath(PlanResult& result, const EdgeChecker& checker,
                 const colored_graph::CostModel& model, double reach) {
  constexpr int kMostRounds = 3;  // later ones gain little
  for (int round = 0; round < kMostRounds && result.path.size() > 2; ++round)
    if (!shortenOnce(result, checker, model, reach)) return;
}

}  // namespace semantic_planning
