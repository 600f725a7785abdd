#include <colored_graph/GraphSearch.h>

#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "CostVector.h"
#include "SearchParts.h"

namespace colored_graph {

/** For cost vectors of any size. */
class ColoredReplanner::Impl {
 public:
  virtual ~Impl() = default;
  virtual PathResult solve() = 0;
  virtual void moveStart(VertexId start) = 0;
};

/** LPA* over cost vectors, from the goal towards the start. The names g and rhs are the paper's.
 *
 * Invariants between calls: rhs(v) = min over edges (v,w) of cost + g(w), 0 at the goal; node.next
 * gives this minimum; v is queued exactly if g(v) != rhs(v). */
template <int N>
class ColoredReplanner::Search : public Impl {
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

  void moveStart(VertexId start) override {
    if (start == m_start) return;
    m_start = start;
    m_startMoved = true;
  }

  PathResult solve() override {
    m_statistics = {};
    PathResult result;
    const auto missing = missingEnd(m_graph, m_start, m_goal);
    const SearchStatus status = missing ? *missing : repairOrForget();
    if (status == SearchStatus::Found) {
      result = assemblePath(m_graph, m_start, bestEdges());
      result.cost = m_costs.parts(m_nodes[m_start].g);
    }
    result.status = status;
    result.statistics = m_statistics;
    return result;
  }

 private:
  using Cost = CostVector<N>;

  struct Node {
    Cost g = Cost::infinite();
    Cost rhs = Cost::infinite();
    Length distance = 0;      // lower bound of the length from the start number `distanceOf`
    unsigned distanceOf = 0;  // 0: none yet
    Incidence next{kNoVertex, kNoEdge};
    const Cost& least() const { return std::min(g, rhs); }
  };

  /** [min(g, rhs) + h; min(g, rhs)]: since h is a length, the smaller second vector is the one with
   * the larger h. */
  struct Key {
    Cost estimate;
    Length distance;
    bool operator==(const Key& o) const { return distance == o.distance && estimate == o.estimate; }
    bool operator<(const Key& o) const {
      const int order = compare(estimate, o.estimate);
      return order != 0 ? order < 0 : distance > o.distance;
    }
  };

  /** A user's function that throws may leave the invariants broken: the next call starts over. */
  SearchStatus repairOrForget() {
    try {
      return repair();
    } catch (...) {
      m_nodes.clear();
      throw;
    }
  }

  SearchStatus repair() {
    StopCheck stop(m_options);
    catchUp();
    bool again = true;
    while (again) {
      if (const auto stopped = computeShortestPath(stop)) return *stopped;
      if (m_nodes[m_start].g.isInfinite())
        return diagnose(m_graph, m_start, m_goal, [this](const Incidence& i) {
          return !m_costs(i.edge, i.neighbor).isInfinite();
        });
      if (const auto stopped = evaluateAlongPath(stop, again)) return *stopped;
      if (again) lookFirst();
    }
    return SearchStatus::Found;
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
      m_queue.growTo(m_nodes.size());
      if (m_startMoved) rekey();
      repairChanged(log);
    }
    m_seen = log.end();
    m_startMoved = false;
  }

  void startOver() {
    m_nodes.assign(m_graph.vertexIdEnd(), Node());
    m_queue.reset(m_nodes.size());
    m_nodes[m_goal].rhs = Cost();
    enqueue(m_goal);
  }

  /** D* Lite would leave the keys and raise k_m instead. Recomputing the keys of the few queued
   * vertices asks less of the lower bound: it only has to be consistent from each start. */
  void rekey() {
    ++m_startNumber;
    m_queue.rekey([this](VertexId v) { return key(v); });
  }

  void repairChanged(const ChangeLog& log) {
    std::vector<VertexId> changed;
    for (std::uint64_t i = m_seen; i < log.end(); ++i) changed.push_back(log[i]);
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const VertexId v : changed) {
      m_nodes[v].distanceOf = 0;  // its id may have been given to another vertex
      if (m_graph.containsVertex(v))
        repairRhs(v);
      else
        forget(v);
    }
  }

  /** A removed vertex: nothing hangs on it, since its neighbors are in the change log too. */
  void forget(VertexId v) {
    m_queue.remove(v);
    m_nodes[v] = Node();
  }

  // --- LPA*

  std::optional<SearchStatus> computeShortestPath(StopCheck& stop) {
    while (!m_queue.empty()) {
      const Node& start = m_nodes[m_start];
      const bool consistent = start.g == start.rhs;
      if (consistent && !(m_queue.top().key < key(m_start))) break;
      const VertexId v = m_queue.top().vertex;
      const auto stopped = mayEvaluate(v) ? stop.now() : stop.inLoop();
      if (stopped) return stopped;
      expand(v);
    }
    return std::nullopt;
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
      m_queue.remove(v);
      for (const Incidence& i : m_graph.incident(v)) lowerRhs(i, v);
    } else {
      node.g = Cost::infinite();
      enqueue(v);
      for (const Incidence& i : m_graph.incident(v))
        if (m_nodes[i.neighbor].next.neighbor == v) repairRhs(i.neighbor);
    }
  }

  /** A vertex whose g fell offers itself to a neighbor. */
  void lowerRhs(const Incidence& i, VertexId next) {
    Node& node = m_nodes[i.neighbor];
    const Cost& before = m_nodes[next].g;
    if (node.rhs < before) return;  // whatever the edge costs
    const Cost cost = before + m_costs(i.edge, next);
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
  std::pair<Cost, Incidence> bestStep(VertexId v) const {
    std::pair<Cost, Incidence> best{Cost::infinite(), {kNoVertex, kNoEdge}};
    for (const Incidence& i : m_graph.incident(v)) {
      const Cost& after = m_nodes[i.neighbor].g;
      if (best.first < after || after.isInfinite()) continue;  // whatever the edge costs
      const Cost cost = after + m_costs(i.edge, i.neighbor);
      const bool tie =
          cost == best.first && !cost.isInfinite() &&
          std::tie(i.neighbor, i.edge) < std::tie(best.second.neighbor, best.second.edge);
      if (cost < best.first || tie) best = {cost, i};
    }
    return best;
  }

  /** Puts v into the queue with its present key, or out of it, as its consistency asks. */
  void enqueue(VertexId v) {
    if (m_nodes[v].g != m_nodes[v].rhs)
      m_queue.set(v, key(v));
    else
      m_queue.remove(v);
  }

  Key key(VertexId v) {
    Node& node = m_nodes[v];
    if (node.distanceOf != m_startNumber) {
      node.distanceOf = m_startNumber;
      node.distance = m_options.lengthBound ? m_options.lengthBound(m_start, v) : 0;
    }
    return {node.least() + m_costs.ofLength(node.distance), node.distance};
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

  /** Evaluates an edge that leads to a vertex. \return whether it is worse than its lower bound;
   * then its ends are repaired */
  bool turnsOutWorse(EdgeId e, VertexId to) {
    const Cost bound = m_costs(e, to);
    ++m_statistics.edgesEvaluated;
    evaluateEdge(m_graph, e, m_options.evaluate);
    m_seen = m_graph.changes().end();
    if (m_costs(e, to) == bound) return false;
    repairRhs(m_graph.edge(e).a);
    repairRhs(m_graph.edge(e).b);
    return true;
  }

  /** Evaluates the path's edges from the start on; stops, and asks for another search, at the first
   * that is worse than its lower bound. */
  std::optional<SearchStatus> evaluateAlongPath(const StopCheck& stop, bool& again) {
    again = false;
    VertexId to = m_start;
    for (const EdgeId e : bestEdges()) {
      to = m_graph.edge(e).other(to);
      if (!isUnevaluated(e)) continue;
      if (const auto stopped = stop.now()) return stopped;
      again = turnsOutWorse(e, to);
      if (again) break;
    }
    return std::nullopt;
  }

  ColoredGraph& m_graph;
  VertexId m_start;
  const VertexId m_goal;
  const CostModel m_model;
  const SearchOptions m_options;
  const EdgeCosts<N> m_costs;
  std::vector<Node> m_nodes;
  VertexQueue<Key> m_queue;
  std::uint64_t m_seen = 0;
  bool m_startMoved = false;
  unsigned m_startNumber = 1;
  SearchStatistics m_statistics;
  bool m_looksFirst = false;
};

PathResult ColoredGraphSearch::search(ColoredGraph& graph, VertexId start, VertexId goal,
                                      const CostModel& model, const SearchOptions& options) {
  return findColoredPath(graph, start, goal, model, options);
}

PathResult ColoredGraphSearch::replan(ColoredGraph& graph, VertexId start, VertexId goal,
                                      const CostModel& model, const SearchOptions& options) {
  if (!m_replanner || m_graph != &graph || m_goal != goal)
    m_replanner.emplace(graph, start, goal, model, options);
  m_graph = &graph;
  m_goal = goal;
  m_replanner->moveStart(start);
  return m_replanner->solve();
}

ColoredReplanner::ColoredReplanner(ColoredGraph& graph, VertexId start, VertexId goal,
                                   const CostModel& model, const SearchOptions& options) {
  model.validate(graph);
  m_impl = withVectorSize(model, [&](auto size) -> std::unique_ptr<Impl> {
    return std::make_unique<Search<size()>>(graph, start, goal, model, options);
  });
}

ColoredReplanner::~ColoredReplanner() = default;
ColoredReplanner::ColoredReplanner(ColoredReplanner&&) noexcept = default;
ColoredReplanner& ColoredReplanner::operator=(ColoredReplanner&&) noexcept = default;

PathResult ColoredReplanner::solve() { return m_impl->solve(); }

void ColoredReplanner::moveStart(VertexId start) { m_impl->moveStart(start); }

PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const SearchOptions& options) {
  return ColoredReplanner(graph, start, goal, model, options).solve();
}

}  // namespace colored_graph
