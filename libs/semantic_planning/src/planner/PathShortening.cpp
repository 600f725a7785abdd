#include "PathShortening.h"

#include <colored_graph/ColoredAStar.h>
#include <semantic_planning/roadmap/PosePair.h>

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

int gearChanges(const std::vector<PathPoint>& path) {
  int changes = 0;
  for (std::size_t i = 1; i < path.size(); ++i) changes += path[i].forward != path[i - 1].forward;
  return changes;
}

/** All curves between the stations that are short enough; vertex i is station i. */
ColoredGraph graphOf(const std::vector<GroundPose>& stations, const EdgeChecker& checker,
                     double reach) {
  ColoredGraph graph(checker.order().classes());
  for (const GroundPose& pose : stations) graph.addVertex(checker.classAt(pose));
  for (VertexId b = 1; b < stations.size(); ++b)
    for (VertexId a = 0; a < b; ++a) {
      const PosePair ends(stations[a], stations[b]);
      if (checker.reedsShepp().lowerBound(ends.first.pose, ends.second.pose) > reach) continue;
      const double length = ends.distance(checker.reedsShepp());
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
    const PosePair ends(stations[edge.a], stations[edge.b]);
    return checker.profile(ends.first, ends.second);
  };
  return options;
}

/** A path of less cost, if there is one. */
std::optional<PlanResult> shortened(const PlanResult& before, const EdgeChecker& checker,
                                    const colored_graph::CostModel& model, double reach) {
  const std::vector<GroundPose> stations = stationsOf(before.path, checker);
  ColoredGraph graph = graphOf(stations, checker, reach);
  const auto last = static_cast<VertexId>(stations.size() - 1);
  const auto path = findColoredPath(graph, 0, last, model, searchOptions(graph, stations, checker));
  if (!path.found() || !(path.cost < before.cost)) return std::nullopt;
  PlanResult after = before;
  after.path.clear();
  after.vertices = {stations.front().pose};
  for (std::size_t i = 1; i < path.vertices.size(); ++i) {
    const GroundPose &from = stations[path.vertices[i - 1]], &to = stations[path.vertices[i]];
    const auto curve = PosePair(from, to).curveFrom(from, checker.reedsShepp());
    appendCurve(checker.trace(curve, from.z), after.path);
    after.vertices.push_back(to.pose);
  }
  setLengths(path, after);
  return after;
}

/** Less way through classes worse than the best; then fewer gear changes; then a shorter way. */
bool isBetter(const PlanResult& l, const PlanResult& r) {
  const auto worth = [](const PlanResult& plan) {
    std::vector<std::int64_t> terms = plan.cost;
    terms.insert(terms.end() - 1, gearChanges(plan.path));
    return terms;
  };
  return worth(l) < worth(r);
}

}  // namespace

void shortenPath(PlanResult& result, const EdgeChecker& checker,
                 const colored_graph::CostModel& model, double reach) {
  constexpr int kMostRounds = 3;  // later ones gain little
  for (int round = 0; round < kMostRounds && result.path.size() > 2; ++round) {
    auto after = shortened(result, checker, model, reach);
    if (!after || !isBetter(*after, result)) return;
    result = std::move(*after);
  }
}

}  // namespace semantic_planning
