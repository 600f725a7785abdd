#pragma once
#include <colored_graph/ColoredAStar.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "EdgeCosts.h"
#include "RadixQueue.h"
#include "SearchParts.h"

namespace colored_graph {

/** One search of COA*, from the goal towards the start. */
template <class Layout>
class ColoredSearch {
 public:
  ColoredSearch(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
                const SearchOptions& options, StopCheck& stop)
      : m_graph(graph),
        m_start(start),
        m_goal(goal),
        m_options(options),
        m_costs(graph, model),
        m_stop(stop),
        m_toGoal(graph.vertexIdEnd()),
        m_expanded(graph.vertexIdEnd()) {}

  /** Nothing if the layout has not enough bits for the costs that were met.
   * \param statistics is counted up. */
  std::optional<PathResult> run(SearchStatistics& statistics) {
    const SearchStatus status = search(statistics);
    if (m_costs.layout().overflowed()) return std::nullopt;
    PathResult result;
    if (status == SearchStatus::Found) result = path();
    result.status = status;
    return result;
  }

 private:
  using Cost = typename Layout::Cost;

  SearchStatus search(SearchStatistics& statistics) {
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
    return diagnose(m_graph, m_start, m_goal, [this](const Incidence& i) {
      return !m_costs(i.edge, i.neighbor).isInfinite();
    });
  }

  void expand(VertexId from) {
    const Cost before = m_toGoal[from];
    for (const Incidence& i : m_graph.incident(from)) {
      const Cost& known = m_toGoal[i.neighbor];
      if (isReached(known) && known < before) continue;  // most are on the way back
      const Cost step = m_costs(i.edge, from);
      if (step.isInfinite()) continue;
      const Cost cost = before + step;
      if (!improves(cost, known)) continue;
      if (m_graph.edge(i.edge).state == EdgeState::Unevaluated)
        m_queue.push({estimate(i.neighbor, cost), i.neighbor, i.edge});
      else
        reach(i.neighbor, cost);
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
    m_queue.push({estimate(v, cost), v, kNoEdge});
  }

  /** Lower bound of the cost of a path through v, given the cost from there: consistent in every
   * component. */
  Cost estimate(VertexId v, const Cost& cost) const {
    return cost + m_costs.layout().ofLength(distance(v));
  }

  Length distance(VertexId v) const {
    constexpr Length kLongest = std::numeric_limits<std::uint32_t>::max() - 1;
    if (!m_options.lengthBound) return 0;
    return std::clamp(m_options.lengthBound(m_start, v), Length{0}, kLongest);
  }

  /** The next edge of a path from v, by which its cost came about; of several the one to the
   * smallest vertex, then that of the smallest id. Each edge counts one, so this makes no cycle. */
  Incidence nextStep(VertexId v) const {
    Incidence best{kNoVertex, kNoEdge};
    for (const Incidence& i : m_graph.incident(v)) {
      const Cost& after = m_toGoal[i.neighbor];
      if (!isReached(after) || m_graph.edge(i.edge).state != EdgeState::Usable) continue;
      const Cost step = m_costs(i.edge, i.neighbor);
      if (step.isInfinite() || !(after + step == m_toGoal[v])) continue;
      if (std::tie(i.neighbor, i.edge) < std::tie(best.neighbor, best.edge)) best = i;
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
  const SearchOptions& m_options;
  const EdgeCosts<Layout> m_costs;
  StopCheck& m_stop;
  std::vector<Cost> m_toGoal;  // and an edge more, so that 0 stands for not reached
  std::vector<bool> m_expanded;
  RadixQueue<Cost> m_queue;
};

}  // namespace colored_graph
