#pragma once
#include "EdgeCosts.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

namespace colored_graph {

constexpr std::int64_t kUnreachable = std::numeric_limits<std::int64_t>::max();

/** For every vertex the least cost in the worst rank of a path from it to `target`, exactly; or
 * kUnreachable. Edges that cost nothing in that rank contract their ends: each such component is
 * flooded at once, and only the edges between components are queued. */
template <int N>
std::vector<std::int64_t> worstRankBound(const ColoredGraph& graph, const EdgeCosts<N>& costs,
                                         Rank worst, VertexId target) {
  std::vector<std::int64_t> bound(graph.vertexIdEnd(), kUnreachable);
  using Entry = std::pair<std::int64_t, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<VertexId> component;
  queue.push({0, target});
  while (!queue.empty()) {
    const auto [amount, first] = queue.top();
    queue.pop();
    component.push_back(first);
    while (!component.empty()) {
      const VertexId v = component.back();
      component.pop_back();
      if (bound[v] != kUnreachable) continue;
      bound[v] = amount;
      for (const Incidence& i : graph.incident(v)) {
        if (bound[i.neighbor] != kUnreachable) continue;
        const CostVector<N> cost = costs(i.edge);
        const std::int64_t step = cost[EdgeCosts<N>::at(worst)];
        if (step == 0)
          component.push_back(i.neighbor);
        else if (!cost.isInfinite() && step < kUnreachable - amount)
          queue.push({amount + step, i.neighbor});
      }
    }
  }
  return bound;
}

}  // namespace colored_graph
