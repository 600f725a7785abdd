#include <colored_graph/ModelNames.h>

namespace colored_graph {

const std::vector<std::pair<const char*, EdgeModel>>& choicesOf(EdgeModel) {
  static const std::vector<std::pair<const char*, EdgeModel>> choices = {
      {"endpoint", EdgeModel::Endpoint},
      {"sweep", EdgeModel::Sweep},
      {"profile", EdgeModel::Profile}};
  return choices;
}

const char* nameOf(EdgeModel model) {
  for (const auto& [name, choice] : choicesOf(model))
    if (choice == model) return name;
  return "";
}

const std::vector<std::pair<const char*, CostKind>>& choicesOf(CostKind) {
  static const std::vector<std::pair<const char*, CostKind>> choices = {
      {"count", CostKind::Count}, {"length", CostKind::ArcLength}};
  return choices;
}

}  // namespace colored_graph
