#pragma once
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/CostModel.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace colored_graph {

/** N non-negative integers, compared from the first (worst class) to the last.
 *
 * (Z_>=0^N, +, <) is strictly and totally ordered, and adding the same vector on both sides keeps
 * the order: all that Dijkstra, A* and LPA* ask of a cost. A sum that overflows in any component is
 * infinite(), which is larger than every other vector. */
template <int N>
class CostVector {
 public:
  constexpr CostVector() : m_parts{} {}

  static constexpr CostVector infinite() {
    CostVector cost;
    for (std::int64_t& part : cost.m_parts) part = kLargest;
    return cost;
  }
  bool isInfinite() const { return *this == infinite(); }

  std::int64_t operator[](int i) const { return m_parts[i]; }
  std::int64_t& operator[](int i) { return m_parts[i]; }

  /** Negative, 0 or positive, as l is less than, equal to or greater than r. */
  friend int compare(const CostVector& l, const CostVector& r) {
    for (int i = 0; i < N; ++i)
      if (l.m_parts[i] != r.m_parts[i]) return l.m_parts[i] < r.m_parts[i] ? -1 : 1;
    return 0;
  }
  friend bool operator==(const CostVector& l, const CostVector& r) { return compare(l, r) == 0; }
  friend bool operator!=(const CostVector& l, const CostVector& r) { return compare(l, r) != 0; }
  friend bool operator<(const CostVector& l, const CostVector& r) { return compare(l, r) < 0; }

  friend CostVector operator+(const CostVector& l, const CostVector& r) {
    CostVector sum;
    std::uint64_t seen = 0;  // the top bit tells whether any component left the range
    for (int i = 0; i < N; ++i) {
      const std::uint64_t part =
          static_cast<std::uint64_t>(l.m_parts[i]) + static_cast<std::uint64_t>(r.m_parts[i]);
      seen |= part;
      sum.m_parts[i] = static_cast<std::int64_t>(part);
    }
    return seen >> 63 ? infinite() : sum;
  }

 private:
  static constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();

  std::array<std::int64_t, N> m_parts;
};

/** What the edges of a graph cost, in vectors of N components: (worst rank, ..., rank 1; total
 * length with tolls, if these count; total length; edges), with zeros in front. Since the number of
 * edges is the last one, every edge costs something, and ties go to fewer edges. */
template <int N>
class EdgeCosts {
 public:
  using Cost = CostVector<N>;

  EdgeCosts(const ColoredGraph& graph, const CostModel& model)
      : m_graph(graph), m_model(model), m_rankZeroAt(model.tolls ? kLengthAt - 1 : kLengthAt) {}

  /** The cost of an edge that is driven to its end `to`, infinite if that cannot be. For an
   * unevaluated edge it is a lower bound, from its end points and least length. */
  Cost operator()(EdgeId e, VertexId to) const {
    const Edge& edge = m_graph.edge(e);
    const Length toll = edge.tollTo(to);
    if (edge.state == EdgeState::Blocked || toll == kClosed) return Cost::infinite();
    Cost cost = ofLength(edge.length);
    cost[kEdgesAt] = 1;
    if (m_model.tolls) cost[m_rankZeroAt] += toll;
    if (m_model.edges == EdgeModel::Profile) return addProfile(edge, cost);
    Rank worst = std::max(rank(m_graph.vertexClass(edge.a)), rank(m_graph.vertexClass(edge.b)));
    if (m_model.edges == EdgeModel::Sweep)
      for (const Stretch& stretch : edge.profile) worst = std::max(worst, rank(stretch.classId));
    return worst == kForbidden ? Cost::infinite() : addToRank(cost, worst, counted(edge.length));
  }

  /** The lower bound `length` of a path's length, as a lower bound of its cost. */
  Cost ofLength(Length length) const {
    Cost cost;
    for (int i = m_rankZeroAt; i <= kLengthAt; ++i) cost[i] = length;
    return cost;
  }

  /** The components that the model has, without the number of edges. */
  std::vector<std::int64_t> parts(const Cost& cost) const {
    std::vector<std::int64_t> parts;
    for (int i = m_rankZeroAt - (m_model.order.ranks() - 1); i <= kLengthAt; ++i)
      parts.push_back(cost[i]);
    return parts;
  }

 private:
  static constexpr int kLengthAt = N - 2, kEdgesAt = N - 1;

  Rank rank(GraphClass id) const { return m_model.order.rank(id); }

  /** What a length in a rank counts for. */
  Length counted(Length length) const { return m_model.kind == CostKind::Count ? 1 : length; }

  Cost addToRank(Cost cost, Rank rank, Length amount) const {
    if (rank > 0) cost[m_rankZeroAt - rank] += amount;
    return cost;
  }

  Cost addProfile(const Edge& edge, Cost cost) const {
    unsigned touched = 0;
    for (const Stretch& stretch : edge.profile) {
      const Rank r = rank(stretch.classId);
      if (r == kForbidden) return Cost::infinite();
      const bool again = m_model.kind == CostKind::Count && (touched >> r & 1);
      cost = addToRank(cost, r, again ? 0 : counted(stretch.length));
      touched |= 1u << r;
    }
    return cost;
  }

  const ColoredGraph& m_graph;
  const CostModel& m_model;
  const int m_rankZeroAt;  ///< where rank 0 would stand
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
