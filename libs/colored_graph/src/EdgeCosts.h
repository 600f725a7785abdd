#pragma once
#include <colored_graph/CostModel.h>
#include <colored_graph/CostVector.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace colored_graph {

/** The costs of a graph's edges as vectors (worst rank, ..., rank 1; total length; edges). With the
 * number of edges as its last component every edge costs something, and ties go to fewer edges.
 * Ranks that the order does not have are zeros in front. */
template <int N>
class EdgeCosts {
 public:
  using Cost = CostVector<N>;
  static constexpr int kLengthAt = N - 2;
  static constexpr int kEdgesAt = N - 1;
  static constexpr int at(Rank rank) { return kLengthAt - rank; }

  EdgeCosts(const ColoredGraph& graph, const CostModel& model) : m_graph(graph), m_model(model) {}

  /** Infinite if the edge cannot be used. Of an unevaluated edge a lower bound, from its end points
   * and least length. */
  Cost operator()(EdgeId e) const {
    const Edge& edge = m_graph.edge(e);
    if (edge.state == EdgeState::Blocked) return Cost::infinite();
    switch (m_model.edges) {
      case EdgeModel::Endpoint:
        return inOneRank(worseEnd(edge), edge.length);
      case EdgeModel::Sweep:
        return inOneRank(worstAlong(edge), edge.length);
      case EdgeModel::Profile:
        break;
    }
    return edge.state == EdgeState::Usable ? ofProfile(edge) : inOneRank(0, edge.length);
  }

  /** The lower bound `length` of a path's length, as a lower bound of its cost. */
  static Cost ofLength(Length length) {
    Cost cost;
    cost[kLengthAt] = length;
    return cost;
  }

  /** The components that the order has, without the number of edges. */
  std::vector<std::int64_t> trimmed(const Cost& cost) const {
    std::vector<std::int64_t> parts;
    for (int i = at(m_model.order.ranks() - 1); i <= kLengthAt; ++i) parts.push_back(cost[i]);
    return parts;
  }

 private:
  Rank rank(GraphClass id) const { return m_model.order.rank(id); }

  Rank worseEnd(const Edge& edge) const {
    return std::max(rank(m_graph.vertexClass(edge.a)), rank(m_graph.vertexClass(edge.b)));
  }

  Rank worstAlong(const Edge& edge) const {
    Rank worst = worseEnd(edge);
    for (const Stretch& stretch : edge.profile) worst = std::max(worst, rank(stretch.classId));
    return worst;
  }

  Cost inOneRank(Rank r, Length length) const {
    if (r == kForbidden) return Cost::infinite();
    Cost cost = ofLength(length);
    cost[kEdgesAt] = 1;
    if (r > 0) cost[at(r)] = m_model.kind == CostKind::Count ? 1 : length;
    return cost;
  }

  Cost ofProfile(const Edge& edge) const {
    Cost cost = ofLength(edge.length);
    cost[kEdgesAt] = 1;
    for (const Stretch& stretch : edge.profile) {
      const Rank r = rank(stretch.classId);
      if (r == kForbidden) return Cost::infinite();
      if (r == 0) continue;
      cost[at(r)] = m_model.kind == CostKind::Count ? 1 : cost[at(r)] + stretch.length;
    }
    return cost;
  }

  const ColoredGraph& m_graph;
  const CostModel& m_model;
};

/** Calls f with the smallest of the vector sizes that holds `ranks` ranks. Short vectors make a
 * search with few classes faster: 16 ranks in all cases would cost about twice the time. */
template <class F>
auto withVectorSize(int ranks, F f) {
  if (ranks <= 2) return f(std::integral_constant<int, 3>{});
  if (ranks <= 4) return f(std::integral_constant<int, 5>{});
  if (ranks <= 8) return f(std::integral_constant<int, 9>{});
  static_assert(kMaxRanks == 16);
  return f(std::integral_constant<int, 17>{});
}

}  // namespace colored_graph
