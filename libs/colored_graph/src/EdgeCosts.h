#pragma once
#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "CostLayouts.h"

namespace colored_graph {

/** What the edges of a graph cost. */
template <int N>
class EdgeCosts {
 public:
  using Cost = CostVector<N>;

  EdgeCosts(const ColoredGraph& graph, const CostModel& model)
      : m_graph(graph), m_model(model), m_layout(model) {}

  const VectorLayout<N>& layout() const { return m_layout; }

  /** The cost of an edge that is driven to its end `to`: infinite if that cannot be; of an
   * unevaluated edge a lower bound, from its end points and least length. */
  Cost operator()(EdgeId e, VertexId to) const {
    const Edge& edge = m_graph.edge(e);
    const Length toll = edge.tollTo(to);
    if (edge.state == EdgeState::Blocked || toll == kClosed) return Cost::infinite();
    Cost cost = m_layout.edge(edge.length, m_model.tolls ? toll : 0);
    if (m_model.edges == EdgeModel::Profile) return addProfile(edge, cost);
    Rank worst = std::max(rank(m_graph.vertexClass(edge.a)), rank(m_graph.vertexClass(edge.b)));
    if (m_model.edges == EdgeModel::Sweep)
      for (const Stretch& stretch : edge.profile) worst = std::max(worst, rank(stretch.classId));
    if (worst == kForbidden) return Cost::infinite();
    m_layout.addToRank(cost, worst, counted(edge.length));
    return cost;
  }

 private:
  Rank rank(GraphClass id) const { return m_model.order.rank(id); }

  /** What a length in a rank counts for. */
  Length counted(Length length) const { return m_model.kind == CostKind::Count ? 1 : length; }

  Cost addProfile(const Edge& edge, Cost cost) const {
    std::array<Length, kMaxRanks> lengths{};
    unsigned touched = 0;
    for (const Stretch& stretch : edge.profile) {
      const Rank r = rank(stretch.classId);
      if (r == kForbidden) return Cost::infinite();
      lengths[r] += stretch.length;
      touched |= 1u << r;
    }
    for (Rank r = 1; r < m_model.order.ranks(); ++r)
      if (touched >> r & 1) m_layout.addToRank(cost, r, counted(lengths[r]));
    return cost;
  }

  const ColoredGraph& m_graph;
  const CostModel& m_model;
  const VectorLayout<N> m_layout;
};

/** Calls f with the smallest of the vector sizes that holds the model's costs. Short vectors make a
 * search with few classes faster: 16 ranks in all cases would cost about twice the time. */
template <class F>
auto withVectorSize(const CostModel& model, F f) {
  const int components = model.components();
  if (components <= 2) return f(std::integral_constant<int, 3>{});
  if (components <= 4) return f(std::integral_constant<int, 5>{});
  if (components <= 8) return f(std::integral_constant<int, 9>{});
  static_assert(kMaxRanks == 16);
  return f(std::integral_constant<int, 18>{});
}

}  // namespace colored_graph
