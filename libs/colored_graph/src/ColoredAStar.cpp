#include <colored_graph/ColoredAStar.h>

#include "EdgeCosts.h"
#include "SearchParts.h"
#include "WorstRankBound.h"

#include <functional>
#include <queue>
#include <tuple>

namespace colored_graph {
namespace {

template <int N>
class ColoredAStar {
 public:
  ColoredAStar(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
               const ColoredAStarOptions& options)
      : m_graph(graph),
        m_start(start),
        m_goal(goal),
        m_model(model),
        m_options(options),
        m_costs(graph, model),
        m_stop(options),
        m_labels(graph.vertexIdEnd()) {}

  PathResult run() {
    const bool ranked = m_model.order.ranks() > 1;
    if (m_options.boundWorstRank && ranked)
      m_worstBound = worstRankBound(m_graph, m_costs, m_model.order.ranks() - 1, m_start);
    const SearchStatus status = search();
    PathResult result;
    if (status == SearchStatus::Found) result = path();
    result.status = status;
    result.statistics = m_statistics;
    return result;
  }

 private:
  using Cost = CostVector<N>;

  /** What is known of the way from a vertex to the goal. */
  struct Label {
    Cost toGoal = Cost::infinite();
    Length distance = kUnknown;  // lower bound of the length from the start
    VertexId next = kNoVertex;
    EdgeId nextEdge = kNoEdge;
    bool open = false;
  };
  static constexpr Length kUnknown = -1;

  /** A vertex to expand, or (edge given) an unevaluated edge that may lead to it. */
  struct Entry {
    Cost estimate;  // of a whole path through here
    VertexId vertex;
    EdgeId edge;
    bool isVertex() const { return edge == kNoEdge; }
    /** Vertices go before edges: a way that is known is worth more than one that may tie it. */
    bool operator>(const Entry& o) const {
      if (const int order = compare(estimate, o.estimate)) return order > 0;
      return std::make_tuple(!isVertex(), vertex, edge) >
             std::make_tuple(!o.isVertex(), o.vertex, o.edge);
    }
  };

  SearchStatus search() {
    reach(m_goal, Cost(), kNoVertex, kNoEdge);
    while (!m_queue.empty()) {
      if (const auto stopped = m_stop.inLoop()) return *stopped;
      const Entry entry = m_queue.top();
      m_queue.pop();
      if (!entry.isVertex()) {
        if (const auto stopped = tryEdge(entry)) return *stopped;
      } else if (m_labels[entry.vertex].open) {
        if (entry.vertex == m_start) return SearchStatus::Found;
        expand(entry.vertex);
      }
    }
    return diagnose(m_graph, m_start, m_goal,
                    [this](EdgeId e) { return !m_costs(e).isInfinite(); });
  }

  void expand(VertexId from) {
    ++m_statistics.expansions;
    m_labels[from].open = false;
    const Cost before = m_labels[from].toGoal;
    for (const Incidence& i : m_graph.incident(from)) {
      const Label& to = m_labels[i.neighbor];
      if (to.toGoal < before) continue;  // whatever the edge costs, and most are on the way back
      const Cost cost = before + m_costs(i.edge);
      if (!improves(cost, from, i.edge, to)) continue;
      if (m_graph.edge(i.edge).state == EdgeState::Unevaluated)
        m_queue.push({cost + startToVertex(i.neighbor), i.neighbor, i.edge});
      else
        reach(i.neighbor, cost, from, i.edge);
    }
  }

  /** Evaluates an edge that came to the front, unless it has become useless meanwhile. */
  std::optional<SearchStatus> tryEdge(const Entry& entry) {
    const VertexId from = m_graph.edge(entry.edge).other(entry.vertex);
    const Cost before = m_labels[from].toGoal;
    if (!(before + m_costs(entry.edge) < m_labels[entry.vertex].toGoal)) return std::nullopt;
    if (m_graph.edge(entry.edge).state == EdgeState::Unevaluated) {
      if (const auto stopped = m_stop.now()) return stopped;
      ++m_statistics.edgesEvaluated;
      evaluateEdge(m_graph, entry.edge, m_options.evaluate);
    }
    const Cost cost = before + m_costs(entry.edge);
    if (improves(cost, from, entry.edge, m_labels[entry.vertex]))
      reach(entry.vertex, cost, from, entry.edge);
    return std::nullopt;
  }

  /** Ties go to the smaller next vertex: its edges count one more, so this makes no cycle. */
  static bool improves(const Cost& cost, VertexId next, EdgeId edge, const Label& label) {
    if (cost.isInfinite()) return false;
    if (const int order = compare(cost, label.toGoal)) return order < 0;
    return std::tie(next, edge) < std::tie(label.next, label.nextEdge);
  }

  void reach(VertexId v, const Cost& cost, VertexId next, EdgeId edge) {
    Label& label = m_labels[v];
    const bool better = cost < label.toGoal;
    label.toGoal = cost;
    label.next = next;
    label.nextEdge = edge;
    if (!better) return;
    label.open = true;
    m_queue.push({cost + startToVertex(v), v, kNoEdge});
  }

  /** Lower bound of the cost from the start to v, consistent in every component. */
  Cost startToVertex(VertexId v) {
    if (!m_worstBound.empty() && m_worstBound[v] == kUnreachable) return Cost::infinite();
    Length& distance = m_labels[v].distance;
    if (distance == kUnknown)
      distance = m_options.lengthBound ? m_options.lengthBound(m_start, v) : 0;
    Cost bound = Costs::ofLength(distance);
    if (!m_worstBound.empty()) bound[Costs::at(m_model.order.ranks() - 1)] = m_worstBound[v];
    return bound;
  }

  PathResult path() const {
    std::vector<EdgeId> edges;
    for (VertexId v = m_start; v != m_goal; v = m_labels[v].next)
      edges.push_back(m_labels[v].nextEdge);
    PathResult result = assemblePath(m_graph, m_start, std::move(edges));
    result.cost = m_costs.trimmed(m_labels[m_start].toGoal);
    return result;
  }

  using Costs = EdgeCosts<N>;

  ColoredGraph& m_graph;
  const VertexId m_start, m_goal;
  const CostModel& m_model;
  const ColoredAStarOptions& m_options;
  const Costs m_costs;
  StopCheck m_stop;
  std::vector<Label> m_labels;
  std::vector<std::int64_t> m_worstBound;  // empty unless asked for
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> m_queue;
  SearchStatistics m_statistics;
};

}  // namespace

PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const ColoredAStarOptions& options) {
  model.validate(graph);
  options.validate();
  if (const auto missing = missingEnd(graph, start, goal)) {
    PathResult result;
    result.status = *missing;
    return result;
  }
  return withVectorSize(model.order.ranks(), [&](auto size) {
    return ColoredAStar<size()>(graph, start, goal, model, options).run();
  });
}

}  // namespace colored_graph
