#include "RoadmapSearch.h"

#include <colored_graph/CostModel.h>

#include "measuring/Stopwatch.h"

namespace planning_study {

using namespace colored_graph;
using measuring::Stopwatch;
using semantic_planning::Roadmap;

namespace {

template <class Evaluate>
PathResult search(const RoadmapTask& task, ColoredGraph& graph, const CostModel& model,
                  const Evaluate& evaluate, Trial& trial) {
  ColoredAStarOptions options;
  options.lengthBound = [&](VertexId a, VertexId b) { return task.roadmap.lengthBound(a, b); };
  double evaluation = 0;  // ms
  options.evaluate = [&](EdgeId e) {
    const Stopwatch watch;
    auto profile = evaluate(e);
    evaluation += watch.milliseconds();
    return profile;
  };
  const Stopwatch clock, processor(measuring::TimeOf::Process);
  const PathResult path = findColoredPath(graph, task.start, task.goal, model, options);
  const double cpu = processor.milliseconds();
  trial.evaluationTime = cpu * evaluation / clock.milliseconds();
  trial.searchTime = cpu - trial.evaluationTime;
  trial.found = path.found();
  trial.status = describe(path.status);
  trial.evaluated = path.statistics.edgesEvaluated;
  trial.expansions = path.statistics.expansions;
  trial.cost = path.cost;
  return path;
}

/** A roadmap's graph whose edges have one number. */
class WeightedGraph {
 public:
  WeightedGraph(const Roadmap& roadmap, const ClassOrder& order)
      : m_roadmap(roadmap), m_order(order), m_graph(1) {
    const ColoredGraph& graph = roadmap.graph();
    for (VertexId v = 0; v < graph.vertexIdEnd(); ++v) m_graph.addVertex(0);
    for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e)
      if (graph.containsEdge(e)) add(e, graph.edge(e));
  }

  ColoredGraph& graph() { return m_graph; }
  std::optional<EdgeProfile> evaluate(EdgeId e) const {
    const auto profile = m_roadmap.evaluate(m_original[e]);
    const auto sum = profile ? weighted(*profile, m_order) : std::nullopt;
    if (!sum) return std::nullopt;
    return EdgeProfile{Stretch{0, *sum}};
  }
  std::vector<Length> lengthPerClass(const PathResult& path) const {
    std::vector<Length> lengths(m_order.classes());
    for (const EdgeId e : path.edges) {
      const auto profile = m_roadmap.evaluate(m_original[e]);
      for (const Stretch& s : *profile) lengths[s.classId] += s.length;
    }
    return lengths;
  }

 private:
  void add(EdgeId original, const Edge& edge) {
    m_graph.addUnevaluatedEdge(edge.a, edge.b, edge.length);
    m_original.push_back(original);
  }

  const Roadmap& m_roadmap;
  const ClassOrder& m_order;
  ColoredGraph m_graph;
  std::vector<EdgeId> m_original;
};

}  // namespace

const char* const kWeighted = "weighted";

std::optional<Length> weighted(const EdgeProfile& profile, const ClassOrder& order) {
  Length sum = 0;
  for (const Stretch& s : profile) {
    const Rank rank = order.rank(s.classId);
    if (rank == kForbidden) return std::nullopt;
    Length weight = 1;
    for (Rank r = 0; r < rank; ++r) weight *= 10;
    sum += weight * s.length;
  }
  return sum;
}

void searchColored(const RoadmapTask& task, EdgeModel model, Trial& trial) {
  trial.judgment = nameOf(model);
  ColoredGraph graph = task.roadmap.graph();
  const auto evaluate = [&](EdgeId e) { return task.roadmap.evaluate(e); };
  const PathResult path = search(task, graph, {task.order, model, task.cost}, evaluate, trial);
  if (path.found()) trial.way = wayOf(path.lengthPerClass, task.order);
}

void searchWeighted(const RoadmapTask& task, Trial& trial) {
  trial.judgment = kWeighted;
  WeightedGraph graph(task.roadmap, task.order);
  const auto evaluate = [&](EdgeId e) { return graph.evaluate(e); };
  const ClassOrder one(1, {{0}});
  const PathResult path =
      search(task, graph.graph(), {one, EdgeModel::Profile, CostKind::ArcLength}, evaluate, trial);
  if (path.found()) trial.way = wayOf(graph.lengthPerClass(path), task.order);
}

}  // namespace planning_study
