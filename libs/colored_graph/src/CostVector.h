#pragma once
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/CostModel.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace colored_graph {

/** Non-negative integers, compared from the first (worst class) to the last.
 *
 * (Z_>=0^N, +, <) is strictly and totally ordered, and adding the same vector on both sides keeps
 * the order: all that Dijkstra, A* and LPA* ask of a cost. A sum that overflows in any component is
 * infinite(), which is larger than every other vector. */
class CostVector {
 public:
  /** Ranks but the best, length with tolls, length, edges. */
  static constexpr int kSize = kMaxRanks + 2;

  static constexpr CostVector infinite() {
    CostVector cost;
    for (std::int64_t& part : cost.m_parts) part = std::numeric_limits<std::int64_t>::max();
    return cost;
  }
  bool isInfinite() const { return *this == infinite(); }

  std::int64_t operator[](int i) const { return m_parts[i]; }
  std::int64_t& operator[](int i) { return m_parts[i]; }

  /** Negative, 0 or positive, as l is less than, equal to or greater than r. */
  friend int compare(const CostVector& l, const CostVector& r) {
    for (int i = 0; i < kSize; ++i)
      if (l.m_parts[i] != r.m_parts[i]) return l.m_parts[i] < r.m_parts[i] ? -1 : 1;
    return 0;
  }
  friend bool operator==(const CostVector& l, const CostVector& r) { return compare(l, r) == 0; }
  friend bool operator!=(const CostVector& l, const CostVector& r) { return compare(l, r) != 0; }
  friend bool operator<(const CostVector& l, const CostVector& r) { return compare(l, r) < 0; }

  friend CostVector operator+(const CostVector& l, const CostVector& r) {
    CostVector sum;
    std::uint64_t seen = 0;  // the top bit tells whether any component left the range
    for (int i = 0; i < kSize; ++i) {
      const std::uint64_t part =
          static_cast<std::uint64_t>(l.m_parts[i]) + static_cast<std::uint64_t>(r.m_parts[i]);
      seen |= part;
      sum.m_parts[i] = static_cast<std::int64_t>(part);
    }
    return seen >> 63 ? infinite() : sum;
  }

 private:
  std::array<std::int64_t, kSize> m_parts{};
};

/** What the edges of a graph cost: (worst rank, ..., rank 1; total length with tolls, if these
 * count; total length; edges), then zeros. Since the number of edges is the last one, every edge
 * costs something, and ties go to fewer edges. */
class EdgeCosts {
 public:
  EdgeCosts(const ColoredGraph& graph, const CostModel& model)
      : m_graph(graph), m_model(model), m_lengthAt(model.components() - 1) {}

  /** The cost of an edge that is driven to its end `to`, infinite if that cannot be. For an
   * unevaluated edge it is a lower bound, from its end points and least length. */
  CostVector operator()(EdgeId e, VertexId to) const {
    const Edge& edge = m_graph.edge(e);
    const Length toll = edge.tollTo(to);
    if (edge.state == EdgeState::Blocked || toll == kClosed) return CostVector::infinite();
    CostVector cost = ofLength(edge.length);
    cost[m_lengthAt + 1] = 1;
    if (m_model.tolls) cost[rankZeroAt()] += toll;
    if (m_model.edges == EdgeModel::Profile) return addProfile(edge, cost);
    Rank worst = std::max(rank(m_graph.vertexClass(edge.a)), rank(m_graph.vertexClass(edge.b)));
    if (m_model.edges == EdgeModel::Sweep)
      for (const Stretch& stretch : edge.profile) worst = std::max(worst, rank(stretch.classId));
    return worst == kForbidden ? CostVector::infinite()
                               : addToRank(cost, worst, counted(edge.length));
  }

  /** The lower bound `length` of a path's length, as a lower bound of its cost. */
  CostVector ofLength(Length length) const {
    CostVector cost;
    for (int i = rankZeroAt(); i <= m_lengthAt; ++i) cost[i] = length;
    return cost;
  }

  /** The components that the model has, without the number of edges. */
  std::vector<std::int64_t> parts(const CostVector& cost) const {
    std::vector<std::int64_t> parts;
    for (int i = 0; i <= m_lengthAt; ++i) parts.push_back(cost[i]);
    return parts;
  }

 private:
  /** Where rank 0 would stand. */
  int rankZeroAt() const { return m_model.order.ranks() - 1; }
  Rank rank(GraphClass id) const { return m_model.order.rank(id); }

  /** What a length in a rank counts for. */
  Length counted(Length length) const { return m_model.kind == CostKind::Count ? 1 : length; }

  CostVector addToRank(CostVector cost, Rank rank, Length amount) const {
    if (rank > 0) cost[rankZeroAt() - rank] += amount;
    return cost;
  }

  CostVector addProfile(const Edge& edge, CostVector cost) const {
    unsigned touched = 0;
    for (const Stretch& stretch : edge.profile) {
      const Rank r = rank(stretch.classId);
      if (r == kForbidden) return CostVector::infinite();
      const bool again = m_model.kind == CostKind::Count && (touched >> r & 1);
      cost = addToRank(cost, r, again ? 0 : counted(stretch.length));
      touched |= 1u << r;
    }
    return cost;
  }

  const ColoredGraph& m_graph;
  const CostModel& m_model;
  const int m_lengthAt;
};

}  // namespace colored_graph
