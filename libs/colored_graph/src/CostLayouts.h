#pragma once
#include <colored_graph/CostModel.h>
#include <colored_graph/Edge.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "CostVector.h"
#include "PackedCost.h"

/** \file Where the components of a cost stand: (worst rank, ..., rank 1; total length with tolls,
 * if these count; total length; edges). With the number of edges as its last component every edge
 * costs something, and ties go to fewer edges. */

namespace colored_graph {

/** In a vector of 64 bits each: always enough. Components that the model does not have are zeros in
 * front. */
template <int N>
class VectorLayout {
 public:
  using Cost = CostVector<N>;

  explicit VectorLayout(const CostModel& model)
      : m_ranks(model.order.ranks()), m_rankZeroAt(model.tolls ? kLengthAt - 1 : kLengthAt) {}

  /** An edge's cost, but for its ranks. */
  Cost edge(Length length, Length toll) const {
    Cost cost = ofLength(length);
    cost[kEdgesAt] = 1;
    if (m_rankZeroAt < kLengthAt) cost[m_rankZeroAt] += toll;
    return cost;
  }
  void addToRank(Cost& cost, Rank rank, Length amount) const {
    if (rank > 0) cost[m_rankZeroAt - rank] += amount;
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
    for (int i = m_rankZeroAt - (m_ranks - 1); i <= kLengthAt; ++i) parts.push_back(cost[i]);
    return parts;
  }
  void check(const Cost&) const {}
  bool overflowed() const { return false; }

 private:
  static constexpr int kLengthAt = N - 2;
  static constexpr int kEdgesAt = N - 1;

  int m_ranks, m_rankZeroAt;
};

/** In 128 bits, where that is enough; it notices when it was not. The uppermost bit of every
 * component stays 0, so that a sum of two that are small enough never reaches the next component.
 */
class PackedLayout {
 public:
  using Cost = PackedCost;

  /** Whether it is worth trying: components of 26 bits or more hold several kilometers. */
  static bool suits(const CostModel& model) { return width(model) >= kLeastWidth; }

  explicit PackedLayout(const CostModel& model)
      : m_ranks(model.order.ranks()),
        m_width(width(model)),
        m_lengths((Bits128{1} << kEdgeBits) |
                  (model.tolls ? Bits128{1} << (kEdgeBits + m_width) : 0)),
        m_toll(model.tolls ? Bits128{1} << (kEdgeBits + m_width) : 0),
        m_components(model.components()) {
    m_guards = Bits128{1} << (kEdgeBits - 1);
    for (int i = 0; i < m_components; ++i) m_guards |= unit(i) << (m_width - 1);
    for (Rank r = 1; r < m_ranks; ++r) m_rankUnits[r] = unit(m_ranks - 1 - r);
  }

  Cost edge(Length length, Length toll) const {
    return Cost(held(length) * m_lengths + held(toll) * m_toll + 1);
  }
  void addToRank(Cost& cost, Rank rank, Length amount) const {
    cost = Cost(cost.bits() + held(amount) * m_rankUnits[rank]);
  }
  Cost ofLength(Length length) const {
    return Cost(static_cast<std::uint64_t>(std::min(length, limit() - 1)) * m_lengths);
  }
  std::vector<std::int64_t> parts(const Cost& cost) const {
    std::vector<std::int64_t> parts;
    for (int i = 0; i < m_components; ++i) parts.push_back(part(cost, i));
    return parts;
  }
  /** Looks whether a sum has left its bits. */
  void check(const Cost& cost) const { m_overflowed |= (cost.bits() & m_guards) != 0; }
  bool overflowed() const { return m_overflowed; }

 private:
  static constexpr int kEdgeBits = 20, kLeastWidth = 26;

  static int width(const CostModel& model) {
    return std::min(62, (PackedCost::kBits - kEdgeBits) / model.components());
  }
  /** Lowest bit of a component, the first is the worst rank's. */
  Bits128 unit(int component) const {
    return Bits128{1} << (kEdgeBits + m_width * (m_components - 1 - component));
  }
  Length limit() const { return Length{1} << (m_width - 1); }
  std::uint64_t held(Length amount) const {
    m_overflowed |= amount >= limit();
    return static_cast<std::uint64_t>(amount);
  }
  Length part(const Cost& cost, int component) const {
    return static_cast<Length>(cost.bits() / unit(component) & ((Bits128{1} << m_width) - 1));
  }

  int m_ranks, m_width;
  Bits128 m_lengths, m_toll, m_guards = 0;
  int m_components;
  std::array<Bits128, kMaxRanks> m_rankUnits{};
  mutable bool m_overflowed = false;
};

}  // namespace colored_graph
