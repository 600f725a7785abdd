#include <colored_graph/CostModel.h>

#include <stdexcept>
#include <string>

namespace colored_graph {
void CostModel::validate(const ColoredGraph& graph) const {
  if (order.classes() != graph.classes())
    throw std::invalid_argument("CostModel: order of " + std::to_string(order.classes()) +
                                " classes for a graph with " + std::to_string(graph.classes()));
}

}  // namespace colored_graph
