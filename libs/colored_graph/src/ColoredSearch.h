#pragma once
#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <tuple>
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
        m_toGoal(graph.vertexIdEnd()),
        m_expanded(graph.vertexIdEnd()),
        m_queue(Soon{graph, m_toGoal}) {}

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

  /** The processor fetches what will soon be asked for: first the vertex, then its edges, then what
   * is known of its neighbors. (In a function that is not inlined, the compiler takes this for
   * nothing and drops it.) */
  struct Soon {
    const ColoredGraph& graph;
    const ZeroedArray<Cost>& toGoal;
    [[gnu::always_inline]] void operator()(const QueueEntry<Cost>& entry, std::size_t turns) const {
      if (turns > 256) return;
      if (turns > 64) return graph.prefetch(entry.vertex);
      const EdgeRow row = graph.row(entry.vertex);
      if (turns <= 4) return neighbors(row);
      __builtin_prefetch(&toGoal[entry.vertex]);
      __builtin_prefetch(row.halves);
      if (row.size > 0) __builtin_prefetch(row.halves + row.size - 1);
    }
    [[gnu::always_inline]] void neighbors(const EdgeRow& row) const {
      for (std::size_t i = 0; i < row.size; ++i)
        __builtin_prefetch(&toGoal[row.halves[i].neighbor]);
    }
  };

  SearchStatus search(SearchStatistics& statistics) {
    if (isHopeless(m_goal)) return reasonForNoPath();
    reach(m_goal, m_costs.layout().edge(0, 0));
    while (!m_queue.empty() && !m_costs.layout().overflowed()) {
      if (const auto stopped = m_stop.inLoop()) return *stopped;
      const QueueEntry<Cost> entry = m_queue.pop();
      if (!entry.isVertex()) {
        if (const auto stopped = tryEdge(entry, statistics)) return *stopped;
      } else if (!m_expanded[entry.vertex]) {  // else a better entry was there before
        if (entry.vertex == m_start) return SearchStatus::Found;
        ++statistics.expansions;
        m_expanded[entry.vertex] = true;
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
    const Cost before = m_toGoal[from];
    const EdgeRow row = m_graph.row(from);
    m_queue.soon().neighbors(row);
    for (std::size_t i = 0; i < row.size; ++i) {
      const HalfEdge half = row.halves[i];
      const Cost& known = m_toGoal[half.neighbor];
      if (isReached(known) && known < before) continue;  // most are on the way back
      const Cost step = m_costs(from, half, Way::In);
      if (step.isInfinite()) continue;
      const Cost cost = before + step;
      if (!improves(cost, known) || isHopeless(half.neighbor)) continue;
      if (m_graph.state(half) == EdgeState::Unevaluated)
        m_queue.push({estimate(half.neighbor, cost), half.neighbor, row.edges[i]});
      else
        reach(half.neighbor, cost);
    }
  }

  /** Evaluates an edge that came to the front, unless it has become useless meanwhile. */
  std::optional<SearchStatus> tryEdge(const QueueEntry<Cost>& entry, SearchStatistics& statistics) {
    const VertexId from = m_graph.edge(entry.edge).other(entry.vertex);
    const Cost& known = m_toGoal[entry.vertex];
    const Cost before = m_toGoal[from];
    if (!improves(before + m_costs(entry.edge, from), known)) return std::nullopt;
    if (m_graph.edge(entry.edge).state == EdgeState::Unevaluated) {
      if (const auto stopped = m_stop.now()) return stopped;
      ++statistics.edgesEvaluated;
      evaluateEdge(m_graph, entry.edge, m_options.evaluate);
    }
    const Cost step = m_costs(entry.edge, from);
    if (!step.isInfinite() && improves(before + step, known)) reach(entry.vertex, before + step);
    return std::nullopt;
  }

  static bool isReached(const Cost& known) { return !(known == Cost()); }

  static bool improves(const Cost& cost, const Cost& known) {
    return !cost.isInfinite() && (!isReached(known) || cost < known);
  }

  void reach(VertexId v, const Cost& cost) {
    m_costs.layout().check(cost);
    m_toGoal[v] = cost;
    m_expanded[v] = false;
    m_graph.prefetch(v);
    m_queue.push({estimate(v, cost), v, kNoEdge});
  }

  /** Whether no way leads from the start to v, as far as the bound of the worst rank knows. */
  bool isHopeless(VertexId v) const {
    return !m_worstBound.empty() && m_worstBound[v] == kUnreachable;
  }

  /** Lower bound of the cost of a path through v, given the cost from there: consistent in every
   * component. */
  Cost estimate(VertexId v, const Cost& cost) const {
    const Cost whole = cost + m_costs.layout().ofLength(distance(v));
    if (m_worstBound.empty()) return whole;
    Cost bound{};
    m_costs.layout().addToRank(bound, m_model.order.ranks() - 1, m_worstBound[v]);
    return whole + bound;
  }

  Length distance(VertexId v) const {
    constexpr Length kLongest = std::numeric_limits<std::uint32_t>::max() - 1;
    if (!m_options.lengthBound) return 0;
    return std::clamp(m_options.lengthBound(m_start, v), Length{0}, kLongest);
  }

  /** The next edge of a path from v, by which its cost came about; of several the one to the
   * smallest vertex, then that of the smallest id. Each edge counts one, so this makes no cycle. */
  Incidence nextStep(VertexId v) const {
    const EdgeRow row = m_graph.row(v);
    Incidence best{kNoVertex, kNoEdge};
    for (std::size_t i = 0; i < row.size; ++i) {
      const HalfEdge& half = row.halves[i];
      const Cost& after = m_toGoal[half.neighbor];
      if (!isReached(after) || m_graph.state(half) != EdgeState::Usable) continue;
      const Cost step = m_costs(v, half, Way::Out);
      if (step.isInfinite() || !(after + step == m_toGoal[v])) continue;
      if (std::tie(half.neighbor, row.edges[i]) < std::tie(best.neighbor, best.edge))
        best = {half.neighbor, row.edges[i]};
    }
    if (best.edge == kNoEdge)
      throw std::invalid_argument("SearchOptions: lengthBound is not consistent");
    return best;
  }

  PathResult path() const {
    std::vector<EdgeId> edges;
    for (VertexId v = m_start; v != m_goal;) {
      const Incidence step = nextStep(v);
      edges.push_back(step.edge);
      v = step.neighbor;
    }
    PathResult result = assemblePath(m_graph, m_start, std::move(edges));
    result.cost = m_costs.layout().parts(m_toGoal[m_start]);
    return result;
  }

  ColoredGraph& m_graph;
  const VertexId m_start, m_goal;
  const CostModel& m_model;
  const ColoredAStarOptions& m_options;
  const EdgeCosts<Layout> m_costs;
  StopCheck& m_stop;
  ZeroedArray<Cost> m_toGoal;  // and an edge more, so that 0 stands for not reached
  std::vector<bool> m_expanded;
  std::vector<std::int64_t> m_worstBound;  // empty unless asked for
  RadixQueue<Cost, Soon> m_queue;
};

}  // namespace colored_graph
