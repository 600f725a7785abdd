#include <colored_graph/ClassOrder.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace colored_graph {
namespace {

[[noreturn]] void rejectOrder(const std::string& what) {
  throw std::invalid_argument("ClassOrder: " + what);
}

}  // namespace

ClassOrder::ClassOrder(int classes, const std::vector<std::vector<GraphClass>>& bestToWorst)
    : m_ranks(static_cast<int>(bestToWorst.size())) {
  if (classes < 1) rejectOrder("a graph has at least one class, not " + std::to_string(classes));
  if (bestToWorst.empty()) rejectOrder("the order is empty: every edge would be forbidden");
  if (m_ranks > kMaxRanks)
    rejectOrder(std::to_string(m_ranks) + " ranks, at most " + std::to_string(kMaxRanks));
  m_rankOfClass.assign(classes, kForbidden);
  for (Rank rank = 0; rank < m_ranks; ++rank) {
    if (bestToWorst[rank].empty()) rejectOrder("rank " + std::to_string(rank) + " has no class");
    for (const GraphClass id : bestToWorst[rank]) assign(id, rank);
  }
  constexpr double kFirstRate = 4, kFactor = 3;  // 4, 12, 36, 108, ...
  m_rates = {0};
  for (double rate = kFirstRate; static_cast<int>(m_rates.size()) < m_ranks; rate *= kFactor)
    m_rates.push_back(std::min(rate, kHighestRate));
}

ClassOrder ClassOrder::withRates(const std::vector<double>& rates) const {
  if (static_cast<int>(rates.size()) + 1 != m_ranks)
    rejectOrder(std::to_string(rates.size()) + " rates for " + std::to_string(m_ranks) +
                " ranks, expected one for each but the best");
  ClassOrder order = *this;
  order.m_rates = {0};
  for (const double rate : rates) {
    const bool isInRange = rate <= kHighestRate || std::isinf(rate);
    if (!(rate >= order.m_rates.back()) || !isInRange) {
      std::ostringstream text;
      text << "rate " << rate << ", expected a number from " << order.m_rates.back()
           << " (the one before) to " << kHighestRate << ", or inf";
      rejectOrder(text.str());
    }
    order.m_rates.push_back(rate);
  }
  return order;
}

ClassOrder ClassOrder::strict() const {
  return withRates(std::vector<double>(static_cast<std::size_t>(m_ranks) - 1,
                                       std::numeric_limits<double>::infinity()));
}

void ClassOrder::assign(GraphClass id, Rank rank) {
  if (id >= classes())
    rejectOrder("class " + std::to_string(id) + " is not one of the " + std::to_string(classes()) +
                " classes");
  if (m_rankOfClass[id] != kForbidden)
    rejectOrder("class " + std::to_string(id) + " is named twice");
  m_rankOfClass[id] = rank;
}

}  // namespace colored_graph
