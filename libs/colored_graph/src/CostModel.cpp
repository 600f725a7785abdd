#include <colored_graph/CostModel.h>

#include <stdexcept>
#include <string>

namespace colored_graph {
namespace {

template <class E>
const char* nameIn(const Choices<E>& choices, E value) {
  for (const auto& [name, choice] : choices)
    if (choice == value) return name;
  throw std::out_of_range("a value without a name");
}

}  // namespace

const Choices<EdgeModel>& choicesOf(EdgeModel) {
  static const Choices<EdgeModel> choices = {{"endpoint", EdgeModel::Endpoint},
                                             {"sweep", EdgeModel::Sweep},
                                             {"profile", EdgeModel::Profile}};
  return choices;
}

const Choices<CostKind>& choicesOf(CostKind) {
  static const Choices<CostKind> choices = {{"count", CostKind::Count},
                                            {"length", CostKind::ArcLength}};
  return choices;
}

const char* nameOf(EdgeModel model) { return nameIn(choicesOf(model), model); }
const char* nameOf(CostKind kind) { return nameIn(choicesOf(kind), kind); }

void CostModel::validate(const ColoredGraph& graph) const {
  if (order.classes() != graph.classes())
    throw std::invalid_argument("CostModel: order of " + std::to_string(order.classes()) +
                                " classes for a graph with " + std::to_string(graph.classes()));
}

}  // namespace colored_graph
