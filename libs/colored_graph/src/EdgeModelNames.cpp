#include <colored_graph/EdgeModelNames.h>

namespace colored_graph {

const char* nameOf(EdgeModel model) {
  static const char* const names[] = {"endpoint", "sweep", "profile"};
  return names[static_cast<int>(model)];
}

std::map<std::string, EdgeModel> edgeModels() {
  std::map<std::string, EdgeModel> models;
  for (const EdgeModel model : {EdgeModel::Endpoint, EdgeModel::Sweep, EdgeModel::Profile})
    models[nameOf(model)] = model;
  return models;
}

}  // namespace colored_graph
