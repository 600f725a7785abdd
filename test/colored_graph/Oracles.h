#pragma once
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/CostModel.h>

#include <optional>
#include <set>
#include <utility>
#include <vector>

// Slow and simple ways to the optimal cost, written without the library's cost vectors.
namespace oracles {

using colored_graph::ColoredGraph;
using colored_graph::CostKind;
using colored_graph::CostModel;
using colored_graph::EdgeId;
using colored_graph::EdgeModel;
using colored_graph::EdgeState;
using colored_graph::VertexId;

/** (worst rank, ..., rank 1; length with tolls, if these count; total length); std::vector compares
 * it as it should be compared. */
using Tuple = std::vector<std::int64_t>;

inline std::optional<Tuple> costOf(const colored_graph::PathResult& result) {
  return result.found() ? std::optional<Tuple>(result.cost) : std::nullopt;
}

inline Tuple zero(const CostModel& model) {
  return Tuple(model.order.ranks() + (model.tolls ? 1 : 0), 0);
}

inline Tuple sum(Tuple l, const Tuple& r) {
  for (std::size_t i = 0; i < l.size(); ++i) l[i] += r[i];
  return l;
}

/** The stretches of the edge as the model sees them: (rank, length). */
inline std::vector<std::pair<int, std::int64_t>> stretchesSeen(const ColoredGraph& graph,
                                                               const CostModel& model, EdgeId e) {
  const colored_graph::Edge edge = graph.edge(e);
  std::vector<std::pair<int, std::int64_t>> own;
  for (const auto& s : edge.profile) own.push_back({model.order.rank(s.classId), s.length});
  if (model.edges == EdgeModel::Profile) return own;
  std::set<int> ranks{model.order.rank(graph.vertexClass(edge.a)),
                      model.order.rank(graph.vertexClass(edge.b))};
  if (model.edges == EdgeModel::Sweep)
    for (const auto& s : own) ranks.insert(s.first);
  return {{*ranks.rbegin(), edge.length}};
}

/** Cost of an evaluated edge, driven to its end `to`, or nothing if it cannot be used. */
inline std::optional<Tuple> edgeCost(const ColoredGraph& graph, const CostModel& model, EdgeId e,
                                     VertexId to) {
  const colored_graph::Edge edge = graph.edge(e);
  const std::int64_t toll = to == edge.a ? edge.tolls.toA : edge.tolls.toB;
  if (edge.state != EdgeState::Usable || toll == colored_graph::kClosed) return std::nullopt;
  Tuple perRank(model.order.ranks(), 0);
  std::int64_t total = 0;
  for (const auto& [rank, length] : stretchesSeen(graph, model, e)) {
    if (rank >= model.order.ranks()) return std::nullopt;
    perRank[rank] = model.kind == CostKind::Count ? 1 : perRank[rank] + length;
    total += length;
  }
  Tuple cost(perRank.rbegin(), perRank.rend() - 1);
  if (model.tolls) cost.push_back(total + toll);
  cost.push_back(total);
  return cost;
}

inline std::optional<Tuple> tupleDijkstra(const ColoredGraph& graph, const CostModel& model,
                                          VertexId start, VertexId goal) {
  std::vector<std::optional<Tuple>> best(graph.vertexIdEnd());
  std::set<std::pair<Tuple, VertexId>> open{{zero(model), start}};
  best[start] = zero(model);
  while (!open.empty()) {
    const auto [cost, v] = *open.begin();
    open.erase(open.begin());
    if (v == goal) return cost;
    for (const auto& i : graph.incident(v)) {
      const auto step = edgeCost(graph, model, i.edge, i.neighbor);
      if (!step) continue;
      const Tuple next = sum(cost, *step);
      std::optional<Tuple>& known = best[i.neighbor];
      if (known && *known <= next) continue;
      if (known) open.erase({*known, i.neighbor});
      known = next;
      open.insert({next, i.neighbor});
    }
  }
  return std::nullopt;
}

}  // namespace oracles
