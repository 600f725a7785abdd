#pragma once
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "EdgeCosts.h"

namespace colored_graph {

constexpr std::int64_t kUnreachable = std::numeric_limits<std::int64_t>::max();

/** For every vertex the least cost in the worst rank of a path to it from `start`, exactly; or
 * kUnreachable. Edges that cost nothing in that rank contract their ends: each such component is
 * flooded at once, and only the edges between components are queued. */
template <class Layout>
std::vector<std::int64_t> worstRankBound(const ColoredGraph& graph, const EdgeCosts<Layout>& costs,
                                         Rank worst, VertexId start) {
  std::vector<std::int64_t> bound(graph.vertexIdEnd(), kUnreachable);
  using Entry = std::pair<std::int64_t, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<VertexId> component;
  const auto leave = [&](VertexId v, const HalfEdge& half) {
    if (bound[half.neighbor] != kUnreachable) return;
    const auto cost = costs(v, half, Way::Out);
    if (cost.isInfinite()) return;
    const std::int64_t step = costs.layout().inRank(cost, worst);
    if (step == 0)
      component.push_back(half.neighbor);
    else if (step < kUnreachable - bound[v])
      queue.push({bound[v] + step, half.neighbor});
  };
  queue.push({0, start});
  while (!queue.empty()) {
    const auto [amount, first] = queue.top();
    queue.pop();
    component.push_back(first);
    while (!component.empty()) {
      const VertexId v = component.back();
      component.pop_back();
      if (bound[v] != kUnreachable) continue;
      bound[v] = amount;
      const EdgeRow row = graph.row(v);
      for (std::size_t i = 0; i < row.size; ++i) leave(v, row.halves[i]);
    }
  }
  return bound;
}

}  // namespace colored_graph
