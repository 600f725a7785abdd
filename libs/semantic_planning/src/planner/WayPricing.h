#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/ColoredGraph.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace semantic_planning {

/** What a length of each class costs beside the price of driving it, in its units. */
class WayPricing {
 public:
  using Length = colored_graph::Length;

  /** \param weights by rank; that of the best is 0 */
  WayPricing(const colored_graph::ClassOrder& order, std::vector<Length> weights)
      : m_order(order), m_weights(std::move(weights)) {}
  /** A length of a class outweighs what is likely of all better ones: sums of 100 km stay in range,
   * and with up to 5 ranks a rank weighs a thousand times the one before. */
  static WayPricing inOrder(const colored_graph::ClassOrder& order) {
    const int ranks = order.ranks();
    const Length factor = Length{1} << (32 / std::max(3, ranks - 1));
    std::vector<Length> weights{0};
    for (Length weight = factor; weights.size() < static_cast<std::size_t>(ranks); weight *= factor)
      weights.push_back(weight);
    return {order, weights};
  }

  Length of(colored_graph::GraphClass id, Length length) const {
    return ofRank(m_order.rank(id), length);
  }
  Length ofRank(colored_graph::Rank rank, Length length) const {
    return m_weights[static_cast<std::size_t>(rank)] * length;
  }
  /** Of a meter of each class, infinite if it is forbidden. */
  std::vector<double> perMeter() const {
    std::vector<double> prices;
    for (int id = 0; id < m_order.classes(); ++id) {
      const colored_graph::Rank rank = m_order.rank(static_cast<colored_graph::GraphClass>(id));
      prices.push_back(rank == colored_graph::kForbidden
                           ? std::numeric_limits<double>::infinity()
                           : static_cast<double>(m_weights[static_cast<std::size_t>(rank)]));
    }
    return prices;
  }
  Length of(const colored_graph::EdgeProfile& profile) const {
    Length cost = 0;
    for (const colored_graph::Stretch& s : profile) cost += of(s.classId, s.length);
    return cost;
  }

 private:
  const colored_graph::ClassOrder& m_order;
  std::vector<Length> m_weights;
};

}  // namespace semantic_planning
