#include <colored_graph/ColoredReplanner.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "CostVector.h"

namespace colored_graph {

/** LPA* over cost vectors, from the goal towards the start. The names g and rhs are the paper's.
 *
 * Invariants between calls: rhs(v) = min over edges (v,w) of cost + g(w), 0 at the goal; node.next
 * gives this minimum; v is queued exactly if g(v) != rhs(v). */
class ColoredReplanner::Search {
 public:
  Search(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
         const SearchOptions& options)
      : m_graph(graph),
        m_start(start),
        m_goal(goal),
        m_model(model),
        m_options(options),
        m_costs(m_graph, m_model) {}
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;

  void moveStart(VertexId start) {
    if (start == m_start) return;
    m_start = start;
    m_startMoved = true;
  }

  PathResult solve() {
    m_statistics = {};
    PathResult result;
    try {
      if (!m_graph.containsVertex(m_start))
        result.status = SearchStatus::StartNotInGraph;
      else if (!m_graph.containsVertex(m_goal))
        result.status = SearchStatus::GoalNotInGraph;
      else
        result = repair();
    } catch (const Cancelled&) {
      result.status = SearchStatus::Cancelled;
    } catch (...) {
      m_nodes.clear();  // a user's function that throws may leave the invariants broken
      throw;
    }
    result.statistics = m_statistics;
    return result;
  }

 private:
  struct Cancelled {};

  /** [min(g, rhs) + h; min(g, rhs)]: since h is a length, the smaller second vector is the one with
   * the larger h. */
  struct Key {
    CostVector estimate;
    Length distance = 0;
    bool operator<(const Key& o) const {
      const int order = compare(estimate, o.estimate);
      return order != 0 ? order < 0 : distance > o.distance;
    }
  };

  struct Node {
    CostVector g = CostVector::infinite();
    CostVector rhs = CostVector::infinite();
    Incidence next{kNoVertex, kNoEdge};
    Key key;  // in the queue
    bool isQueued = false;
  };

  PathResult repair() {
    catchUp();
    for (;; lookFirst()) {
      computeShortestPath();
      if (m_nodes[m_start].g.isInfinite()) {
        PathResult none;
        none.status = whyNot();
        return none;
      }
      if (!turnsOutWorseOnPath()) return path();
    }
  }

  /** Edges on best paths alone are the fewest, but each that is worse than its bound may make a
   * search of the whole graph. That ends when it has taken as long as all edges take. */
  void lookFirst() {
    constexpr std::size_t kExpansions = 7;  // in the time of an evaluated edge of a roadmap
    if (m_looksFirst || m_statistics.expansions < kExpansions * m_graph.edgeCount()) return;
    m_looksFirst = true;
    startOver();
  }

  // --- What happened since the last call

  void catchUp() {
    const ChangeLog& log = m_graph.changes();
    if (m_nodes.empty() || m_seen < log.begin()) {
      startOver();
    } else {
      m_nodes.resize(std::max<std::size_t>(m_nodes.size(), m_graph.vertexIdEnd()));
      if (m_startMoved) rekey();
      repairChanged(log);
    }
    m_seen = log.end();
    m_startMoved = false;
  }

  void startOver() {
    m_nodes.assign(m_graph.vertexIdEnd(), Node());
    m_queue.clear();
    m_nodes[m_goal].rhs = CostVector();
    enqueue(m_goal);
  }

  /** D* Lite would leave the keys and raise k_m instead. Recomputing the keys of the few queued
   * vertices asks less of the lower bound: it only has to be consistent from each start. */
  void rekey() {
    for (const auto& [key, v] : std::exchange(m_queue, {})) {
      m_nodes[v].isQueued = false;
      enqueue(v);
    }
  }

  void repairChanged(const ChangeLog& log) {
    std::vector<VertexId> changed;
    for (std::uint64_t i = m_seen; i < log.end(); ++i) changed.push_back(log[i]);
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const VertexId v : changed) {
      if (m_graph.containsVertex(v))
        repairRhs(v);
      else
        remove(v);
    }
  }

  /** Nothing hangs on it, since its neighbors are in the change log too. */
  void remove(VertexId v) {
    dequeue(v);
    m_nodes[v] = Node();
  }

  // --- LPA*

  void computeShortestPath() {
    while (!m_queue.empty()) {
      const Node& start = m_nodes[m_start];
      if (start.g == start.rhs && !(m_queue.begin()->first < key(m_start))) break;
      checkCancelled();
      expand(m_queue.begin()->second);
    }
  }

  void checkCancelled() const {
    if (m_options.cancelled && m_options.cancelled()) throw Cancelled();
  }

  /** Whether its edge is looked at before anything hangs on it. */
  bool mayEvaluate(VertexId v) const {
    const Node& node = m_nodes[v];
    return m_looksFirst && node.rhs < node.g && v != m_goal && isUnevaluated(node.next.edge);
  }

  void expand(VertexId v) {
    Node& node = m_nodes[v];
    if (mayEvaluate(v) && turnsOutWorse(node.next.edge, node.next.neighbor)) return;
    ++m_statistics.expansions;
    if (node.rhs < node.g) {
      node.g = node.rhs;
      dequeue(v);
      for (const Incidence& i : m_graph.incident(v)) lowerRhs(i, v);
    } else {
      node.g = CostVector::infinite();
      enqueue(v);
      for (const Incidence& i : m_graph.incident(v))
        if (m_nodes[i.neighbor].next.neighbor == v) repairRhs(i.neighbor);
    }
  }

  /** A vertex whose g fell offers itself to a neighbor. */
  void lowerRhs(const Incidence& i, VertexId next) {
    Node& node = m_nodes[i.neighbor];
    const CostVector& before = m_nodes[next].g;
    if (node.rhs < before) return;  // whatever the edge costs
    const CostVector cost = before + m_costs(i.edge, next);
    if (!(cost < node.rhs)) return;
    node.rhs = cost;
    node.next = {next, i.edge};
    enqueue(i.neighbor);
  }

  void repairRhs(VertexId v) {
    if (v == m_goal) return;
    Node& node = m_nodes[v];
    const auto [cost, incidence] = bestStep(v);
    node.rhs = cost;
    node.next = incidence;
    enqueue(v);
  }

  /** The edge with the least cost + g, and that cost; ties to the smaller vertex, then edge. */
  std::pair<CostVector, Incidence> bestStep(VertexId v) const {
    std::pair<CostVector, Incidence> best{CostVector::infinite(), {kNoVertex, kNoEdge}};
    for (const Incidence& i : m_graph.incident(v)) {
      const CostVector& after = m_nodes[i.neighbor].g;
      if (best.first < after || after.isInfinite()) continue;  // whatever the edge costs
      const CostVector cost = after + m_costs(i.edge, i.neighbor);
      const bool tie =
          cost == best.first && !cost.isInfinite() &&
          std::tie(i.neighbor, i.edge) < std::tie(best.second.neighbor, best.second.edge);
      if (cost < best.first || tie) best = {cost, i};
    }
    return best;
  }

  /** Puts v into the queue with its present key, or out of it, as its consistency asks. */
  void enqueue(VertexId v) {
    dequeue(v);
    Node& node = m_nodes[v];
    if (node.g == node.rhs) return;
    node.key = key(v);
    m_queue.insert({node.key, v});
    node.isQueued = true;
  }
  void dequeue(VertexId v) {
    if (m_nodes[v].isQueued) m_queue.erase({m_nodes[v].key, v});
    m_nodes[v].isQueued = false;
  }

  Key key(VertexId v) const {
    const Length distance = m_options.lengthBound ? m_options.lengthBound(m_start, v) : 0;
    return {std::min(m_nodes[v].g, m_nodes[v].rhs) + m_costs.ofLength(distance), distance};
  }

  // --- The path

  /** Only after computeShortestPath(). Then every vertex on the way is consistent, and g falls with
   * each step, at least by one edge, unless the lower bound of lengths is none. */
  std::vector<EdgeId> bestEdges() const {
    std::vector<EdgeId> edges;
    for (VertexId v = m_start; v != m_goal;) {
      const Incidence step = bestStep(v).second;
      if (step.edge == kNoEdge || edges.size() >= m_graph.vertexCount())
        throw std::invalid_argument("SearchOptions: lengthBound is not consistent");
      edges.push_back(step.edge);
      v = step.neighbor;
    }
    return edges;
  }

  bool isUnevaluated(EdgeId e) const { return m_graph.edge(e).state == EdgeState::Unevaluated; }

  PathResult path() const {
    PathResult result;
    result.status = SearchStatus::Found;
    result.vertices = {m_start};
    result.edges = bestEdges();
    result.cost = m_costs.parts(m_nodes[m_start].g);
    result.lengthPerClass.assign(m_graph.classes(), 0);
    for (const EdgeId e : result.edges) {
      const Edge& edge = m_graph.edge(e);
      result.vertices.push_back(edge.other(result.vertices.back()));
      for (const Stretch& s : edge.profile) result.lengthPerClass[s.classId] += s.length;
    }
    return result;
  }

  SearchStatus whyNot() const {
    const auto isCounted = [this](const Incidence& i) {
      return !m_costs(i.edge, i.neighbor).isInfinite();
    };
    const auto isOpen = [this](const Incidence& i) {
      const Edge& edge = m_graph.edge(i.edge);
      return edge.state != EdgeState::Blocked && edge.leadsTo(i.neighbor);
    };
    return isConnected(isCounted) ? SearchStatus::CostOverflow
           : isConnected(isOpen)  ? SearchStatus::OnlyForbidden
                                  : SearchStatus::NotConnected;
  }

  /** Whether edges that are passable lead from start to goal. */
  template <class Passable>
  bool isConnected(Passable passable) const {
    std::vector<bool> seen(m_graph.vertexIdEnd(), false);
    std::vector<VertexId> open{m_start};
    seen[m_start] = true;
    while (!open.empty() && !seen[m_goal]) {
      const VertexId v = open.back();
      open.pop_back();
      for (const Incidence& i : m_graph.incident(v)) {
        if (seen[i.neighbor] || !passable(i)) continue;
        seen[i.neighbor] = true;
        open.push_back(i.neighbor);
      }
    }
    return seen[m_goal];
  }

  /** Evaluates an edge that leads to a vertex. \return whether it is worse than its lower bound;
   * then its ends are repaired */
  bool turnsOutWorse(EdgeId e, VertexId to) {
    if (!m_options.evaluate)
      throw std::invalid_argument("SearchOptions: edge " + std::to_string(e) +
                                  " is unevaluated, and there is no function to evaluate it");
    const CostVector bound = m_costs(e, to);
    ++m_statistics.edgesEvaluated;
    if (std::optional<EdgeProfile> profile = m_options.evaluate(e))
      m_graph.setProfile(e, std::move(*profile));
    else
      m_graph.setBlocked(e);
    m_seen = m_graph.changes().end();
    if (m_costs(e, to) == bound) return false;
    repairRhs(m_graph.edge(e).a);
    repairRhs(m_graph.edge(e).b);
    return true;
  }

  /** Evaluates the path's edges from the start on, up to the first that is worse than its lower
   * bound. \return whether there is one */
  bool turnsOutWorseOnPath() {
    VertexId to = m_start;
    for (const EdgeId e : bestEdges()) {
      to = m_graph.edge(e).other(to);
      if (!isUnevaluated(e)) continue;
      checkCancelled();
      if (turnsOutWorse(e, to)) return true;
    }
    return false;
  }

  ColoredGraph& m_graph;
  VertexId m_start;
  const VertexId m_goal;
  const CostModel m_model;
  const SearchOptions m_options;
  const EdgeCosts m_costs;
  std::vector<Node> m_nodes;
  std::set<std::pair<Key, VertexId>> m_queue;
  std::uint64_t m_seen = 0;
  bool m_startMoved = false;
  SearchStatistics m_statistics;
  bool m_looksFirst = false;
};

ColoredReplanner::ColoredReplanner(ColoredGraph& graph, VertexId start, VertexId goal,
                                   const CostModel& model, const SearchOptions& options)
    : m_search(std::make_unique<Search>(graph, start, goal, model, options)) {
  if (model.order.classes() != graph.classes())
    throw std::invalid_argument("CostModel: order of " + std::to_string(model.order.classes()) +
                                " classes for a graph with " + std::to_string(graph.classes()));
}

ColoredReplanner::~ColoredReplanner() = default;
ColoredReplanner::ColoredReplanner(ColoredReplanner&&) noexcept = default;
ColoredReplanner& ColoredReplanner::operator=(ColoredReplanner&&) noexcept = default;

PathResult ColoredReplanner::solve() { return m_search->solve(); }

void ColoredReplanner::moveStart(VertexId start) { m_search->moveStart(start); }

PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const SearchOptions& options) {
  return ColoredReplanner(graph, start, goal, model, options).solve();
}

}  // namespace colored_graph
