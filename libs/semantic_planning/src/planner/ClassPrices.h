#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace semantic_planning {

/** What a length of each class costs beside the cost of driving it, in its units: the rates of an
 * order. Infinite rates are so large that a length of such a rank outweighs likely lengths of all
 * better ones. Sums of 100 km stay below 2^62. */
class ClassPrices {
 public:
  using Length = colored_graph::Length;

  explicit ClassPrices(const colored_graph::ClassOrder& order) : m_order(order) {
    const double outweighs = std::exp2(32 / std::max(3, order.ranks() - 1));
    for (colored_graph::Rank rank = 0; rank < order.ranks(); ++rank) {
      const double rate = order.rate(rank);
      m_rates.push_back(std::isfinite(rate) ? rate : std::max(1., m_rates.back()) * outweighs);
    }
  }

  double rate(colored_graph::Rank rank) const { return m_rates[static_cast<std::size_t>(rank)]; }
  Length ofRank(colored_graph::Rank rank, Length length) const {
    return static_cast<Length>(rate(rank) * static_cast<double>(length));
  }
  Length of(colored_graph::GraphClass id, Length length) const {
    return ofRank(m_order.rank(id), length);
  }
  Length of(const colored_graph::EdgeProfile& profile) const {
    Length cost = 0;
    for (const colored_graph::Stretch& s : profile) cost += of(s.classId, s.length);
    return cost;
  }
  /** What a meter of each class costs, infinite if it is forbidden. */
  std::vector<double> perMeter() const {
    std::vector<double> prices;
    for (int id = 0; id < m_order.classes(); ++id) {
      const colored_graph::Rank rank = m_order.rank(static_cast<colored_graph::GraphClass>(id));
      prices.push_back(rank == colored_graph::kForbidden ? std::numeric_limits<double>::infinity()
                                                         : rate(rank));
    }
    return prices;
  }

 private:
  const colored_graph::ClassOrder& m_order;
  std::vector<double> m_rates;  ///< by rank
};

}  // namespace semantic_planning
