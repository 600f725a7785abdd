#include <colored_graph/ClassOrder.h>

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
