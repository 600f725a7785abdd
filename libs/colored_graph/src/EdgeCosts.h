#pragma once
#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include "CostLayouts.h"

namespace colored_graph {

/** What the edges of a graph cost. */
template <class Layout>
class EdgeCosts {
 public:
  using Cost = typename Layout::Cost;

  EdgeCosts(const ColoredGraph& graph, const CostModel& model)
      : m_graph(graph), m_model(model), m_layout(model) {
    m_rankOfKind.fill(0);
    m_rankOfKind[HalfEdge::kBlocked] = kForbidden;
    if (model.edges == EdgeModel::Endpoint) return;
    for (unsigned kind = HalfEdge::kFirstClass; kind < HalfEdge::kKinds; ++kind)
      if (const unsigned id = kind - HalfEdge::kFirstClass; static_cast<int>(id) < graph.classes())
        m_rankOfKind[kind] = rank(static_cast<GraphClass>(id));
  }

  const Layout& layout() const { return m_layout; }

  /** The cost of an edge at v, driven away from v or to it: infinite if that cannot be; of an
   * unevaluated edge a lower bound, from its end points and least length. */
  [[gnu::always_inline]] Cost operator()(VertexId v, const HalfEdge& half, Way way) const {
    if (half.isWide()) return ofWide(v, half, way);
    const Rank own = m_rankOfKind[half.kind()];
    const Rank r = m_model.edges == EdgeModel::Profile ? own : std::max(own, worseEnd(v, half));
    if (r == kForbidden || !half.leads(way)) return Cost::infinite();
    return m_layout.narrow(half.length(), r, counted(half.length()));
  }
  /** The cost of an edge that is driven to its end `to`. */
  Cost operator()(EdgeId e, VertexId to) const { return (*this)(to, m_graph.half(e, to), Way::In); }

 private:
  Rank rank(GraphClass id) const { return m_model.order.rank(id); }

  Rank worseEnd(VertexId v, const HalfEdge& half) const {
    return std::max(rank(m_graph.vertexClass(v)), rank(m_graph.vertexClass(half.neighbor)));
  }

  /** What a length in a rank counts for. */
  Length counted(Length length) const { return m_model.kind == CostKind::Count ? 1 : length; }

  Cost ofWide(VertexId v, const HalfEdge& half, Way way) const {
    const WideEdge& edge = m_graph.wide(half);
    const Length toll = edge.toll(v, way);
    if (edge.state == EdgeState::Blocked || toll == kClosed) return Cost::infinite();
    Cost cost = m_layout.edge(edge.length, m_model.tolls ? toll : 0);
    if (m_model.edges == EdgeModel::Profile) return addProfile(edge, cost);
    Rank worst = worseEnd(v, half);
    if (m_model.edges == EdgeModel::Sweep)
      for (const Stretch& stretch : edge.profile) worst = std::max(worst, rank(stretch.classId));
    if (worst == kForbidden) return Cost::infinite();
    m_layout.addToRank(cost, worst, counted(edge.length));
    return cost;
  }

  Cost addProfile(const WideEdge& edge, Cost cost) const {
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
  const Layout m_layout;
  std::array<Rank, HalfEdge::kKinds> m_rankOfKind;
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
