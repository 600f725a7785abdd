#pragma once
#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "EdgeCosts.h"
#include "RadixQueue.h"
#include "SearchParts.h"
#include "WorstRankBound.h"

namespace colored_graph {

/** Zeros that take no memory before they are looked at. */
template <class T>
class ZeroedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  explicit ZeroedArray(std::size_t size) : m_data(static_cast<T*>(std::calloc(size, sizeof(T)))) {
    if (!m_data && size > 0) throw std::bad_alloc();
  }
  T& operator[](std::size_t i) { return m_data.get()[i]; }
  const T& operator[](std::size_t i) const { return m_data.get()[i]; }

 private:
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  std::unique_ptr<T, Free> m_data;
};

/** One search of COA*, from the goal towards the start. */
template <class Layout>
class ColoredSearch {
 public:
  ColoredSearch(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
                const ColoredAStarOptions& options, StopCheck& stop)
      : m_graph(graph),
        m_start(start),
        m_goal(goal),
        m_model(model),
        m_options(options),
        m_costs(graph, model),
        m_stop(stop),
        m_labels(graph.vertexIdEnd()),
        m_queue(Soon{graph, m_labels}) {}

  /** Nothing if the layout has not enough bits for the costs that were met.
   * \param statistics is counted up. */
  std::optional<PathResult> run(SearchStatistics& statistics) {
    if (m_options.boundWorstRank && m_model.order.ranks() > 1)
      m_worstBound = worstRankBound(m_graph, m_costs, m_model.order.ranks() - 1, m_start);
    const SearchStatus status = search(statistics);
    if (m_costs.layout().overflowed()) return std::nullopt;
    PathResult result;
    if (status == SearchStatus::Found) result = path();
    result.status = status;
    return result;
  }

 private:
  using Cost = typename Layout::Cost;

  /** What is known of the way from a vertex to the goal. */
  struct Label {
    Cost cost;               // if there is a next vertex
    std::uint32_t next;      // the next vertex plus 1, of the goal itself; 0: not reached
    std::uint32_t distance;  // lower bound of the length from the start plus 1; 0: not asked yet
  };

  /** The processor fetches what will soon be asked for: first the vertex, then its edges. (In a
   * function that is not inlined, the compiler takes this for nothing and drops it.) */
  struct Soon {
    const ColoredGraph& graph;
    const ZeroedArray<Label>& labels;
    [[gnu::always_inline]] void operator()(const QueueEntry<Cost>& entry, std::size_t turns) const {
      if (turns > 256) return;
      graph.prefetch(entry.vertex);
      if (turns > 64) return;
      __builtin_prefetch(&labels[entry.vertex]);
      const EdgeRow row = graph.row(entry.vertex);
      __builtin_prefetch(row.halves);
      if (row.size > 0) __builtin_prefetch(row.halves + row.size - 1);
    }
  };

  SearchStatus search(SearchStatistics& statistics) {
    if (isHopeless(m_goal)) return reasonForNoPath();
    reach(m_goal, Cost(), m_goal);
    while (!m_queue.empty() && !m_costs.layout().overflowed()) {
      if (const auto stopped = m_stop.inLoop()) return *stopped;
      const QueueEntry<Cost> entry = m_queue.pop();
      if (!entry.isVertex()) {
        if (const auto stopped = tryEdge(entry, statistics)) return *stopped;
      } else if (entry.key == estimate(entry.vertex, m_labels[entry.vertex].cost)) {
        if (entry.vertex == m_start) return SearchStatus::Found;
        ++statistics.expansions;
        expand(entry.vertex);
      }
    }
    return m_costs.layout().overflowed() ? SearchStatus::CostOverflow : reasonForNoPath();
  }

  SearchStatus reasonForNoPath() const {
    return diagnose(m_graph, m_start, m_goal, [this](VertexId v, const HalfEdge& half) {
      return !m_costs(v, half, Way::Out).isInfinite();
    });
  }

  void expand(VertexId from) {
    const Cost before = m_labels[from].cost;
    const EdgeRow row = m_graph.row(from);
    for (std::size_t i = 0; i < row.size; ++i) {
      const HalfEdge half = row.halves[i];
      const Label& to = m_labels[half.neighbor];
      if (to.next != 0 && to.cost < before) continue;  // most are on the way back
      const Cost step = m_costs(from, half, Way::In);
      if (step.isInfinite()) continue;
      const Cost cost = before + step;
      if (!improves(cost, from, to) || isHopeless(half.neighbor)) continue;
      if (m_graph.state(half) == EdgeState::Unevaluated)
        m_queue.push({estimate(half.neighbor, cost), half.neighbor, row.edges[i]});
      else
        reach(half.neighbor, cost, from);
    }
  }

  /** Evaluates an edge that came to the front, unless it has become useless meanwhile. */
  std::optional<SearchStatus> tryEdge(const QueueEntry<Cost>& entry, SearchStatistics& statistics) {
    const VertexId from = m_graph.edge(entry.edge).other(entry.vertex);
    const Label& to = m_labels[entry.vertex];
    const Cost before = m_labels[from].cost;
    if (to.next != 0 && !(before + m_costs(entry.edge, from) < to.cost)) return std::nullopt;
    if (m_graph.edge(entry.edge).state == EdgeState::Unevaluated) {
      if (const auto stopped = m_stop.now()) return stopped;
      ++statistics.edgesEvaluated;
      evaluateEdge(m_graph, entry.edge, m_options.evaluate);
    }
    const Cost step = m_costs(entry.edge, from);
    if (!step.isInfinite() && improves(before + step, from, to))
      reach(entry.vertex, before + step, from);
    return std::nullopt;
  }

  /** Ties go to the smaller next vertex: its edges count one more, so this makes no cycle. */
  static bool improves(const Cost& cost, VertexId next, const Label& label) {
    if (cost.isInfinite()) return false;
    if (label.next == 0 || cost < label.cost) return true;
    return cost == label.cost && next + 1 < label.next;
  }

  void reach(VertexId v, const Cost& cost, VertexId next) {
    m_costs.layout().check(cost);
    Label& label = m_labels[v];
    const bool better = label.next == 0 || cost < label.cost;
    label.cost = cost;
    label.next = next + 1;
    if (better) m_queue.push({estimate(v, cost), v, kNoEdge});
  }

  /** Whether no way leads from the start to v, as far as the bound of the worst rank knows. */
  bool isHopeless(VertexId v) const {
    return !m_worstBound.empty() && m_worstBound[v] == kUnreachable;
  }

  /** Lower bound of the cost of a path through v, given the cost from there: consistent in every
   * component. */
  Cost estimate(VertexId v, const Cost& cost) {
    const Cost whole = cost + m_costs.layout().ofLength(distance(v));
    if (m_worstBound.empty()) return whole;
    Cost bound{};
    m_costs.layout().addToRank(bound, m_model.order.ranks() - 1, m_worstBound[v]);
    return whole + bound;
  }

  Length distance(VertexId v) {
    constexpr Length kLongest = std::numeric_limits<std::uint32_t>::max() - 1;
    std::uint32_t& known = m_labels[v].distance;
    if (known == 0) {
      const Length bound = m_options.lengthBound ? m_options.lengthBound(m_start, v) : 0;
      known = static_cast<std::uint32_t>(std::clamp(bound, Length{0}, kLongest) + 1);
    }
    return known - 1;
  }

  /** The edge that the label of v stands for; the first by id where there are several. */
  EdgeId edgeToNext(VertexId v) const {
    const VertexId next = m_labels[v].next - 1;
    const EdgeRow row = m_graph.row(v);
    EdgeId best = kNoEdge;
    for (std::size_t i = 0; i < row.size; ++i) {
      const HalfEdge& half = row.halves[i];
      if (half.neighbor != next || m_graph.state(half) != EdgeState::Usable) continue;
      const Cost step = m_costs(v, half, Way::Out);
      if (!step.isInfinite() && m_labels[next].cost + step == m_labels[v].cost)
        best = std::min(best, row.edges[i]);
    }
    return best;
  }

  PathResult path() const {
    std::vector<EdgeId> edges;
    for (VertexId v = m_start; v != m_goal; v = m_labels[v].next - 1)
      edges.push_back(edgeToNext(v));
    PathResult result = assemblePath(m_graph, m_start, std::move(edges));
    result.cost = m_costs.layout().parts(m_labels[m_start].cost);
    return result;
  }

  ColoredGraph& m_graph;
  const VertexId m_start, m_goal;
  const CostModel& m_model;
  const ColoredAStarOptions& m_options;
  const EdgeCosts<Layout> m_costs;
  StopCheck& m_stop;
  ZeroedArray<Label> m_labels;
  std::vector<std::int64_t> m_worstBound;  // empty unless asked for
  RadixQueue<Cost, Soon> m_queue;
};

}  // namespace colored_graph
