#pragma once
#include <colored_graph/CostModel.h>
#include <colored_graph/Edge.h>

#include <cstdint>
#include <vector>

#include "CostVector.h"

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

 private:
  static constexpr int kLengthAt = N - 2;
  static constexpr int kEdgesAt = N - 1;

  int m_ranks, m_rankZeroAt;
};

}  // namespace colored_graph
