#include <semantic_planning/planner/OrderFile.h>

#include <semantic_abstraction/AbstractionOptions.h>
#include <strict_files/StrictYaml.h>

#include <limits>
#include <set>
#include <stdexcept>

namespace semantic_planning {

using colored_graph::ClassOrder;
using semantic_types::ClassTable;
using strict_files::StrictYaml;
using OrderId = colored_graph::GraphClass;

namespace {

double readRate(const StrictYaml& yaml, const YAML::Node& node) {
  if (node.IsScalar() && node.Scalar() == "inf") return std::numeric_limits<double>::infinity();
  return yaml.number(node, "rates");
}

ClassOrder readOrder(const StrictYaml& yaml, const ClassTable& classes, const YAML::Node& list) {
  std::set<std::string> named;
  const auto classNamed = [&](const YAML::Node& node) {
    const std::string name = yaml.text(node, "a class");
    const auto id = classes.find(name);
    if (!id && name != kUnknownGround) yaml.fail(node, "the map has no class '" + name + "'");
    if (!named.insert(name).second) yaml.fail(node, "'" + name + "' is named twice");
    return OrderId(id.value_or(semantic_types::kNoClass));
  };
  yaml.checkList(list, "best_to_worst");
  std::vector<std::vector<OrderId>> ranks;
  for (const YAML::Node& rank : list) {
    std::vector<OrderId>& ids = ranks.emplace_back();
    if (rank.IsScalar()) {
      ids.push_back(classNamed(rank));
      continue;
    }
    yaml.checkList(rank, "best_to_worst");
    for (const YAML::Node& name : rank) ids.push_back(classNamed(name));
  }
  try {
    return ClassOrder(classes.size() + 1, ranks);
  } catch (const std::invalid_argument& e) {
    yaml.fail(list, e.what());
  }
}

}  // namespace

ClassOrder loadClassOrder(const std::filesystem::path& file, const ClassTable& classes) {
  const StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), {"best_to_worst", "rates"});
  const ClassOrder order = readOrder(yaml, classes, yaml.required(yaml.root(), "best_to_worst"));
  const YAML::Node list = yaml.root()["rates"];
  if (!list) return order;
  std::vector<double> rates;
  if (!list.IsSequence()) yaml.fail(list, "'rates' is not a list");
  for (const YAML::Node& rate : list) rates.push_back(readRate(yaml, rate));
  try {
    return order.withRates(rates);
  } catch (const std::invalid_argument& e) {
    yaml.fail(list, e.what());
  }
}

semantic_octree::AbstractionOptions abstractionFor(const colored_graph::ClassOrder& order) {
  std::vector<std::vector<int>> groups(order.ranks());
  for (int id = 1; id < order.classes(); ++id) {  // 0 would be free space
    const colored_graph::Rank rank = order.rank(static_cast<colored_graph::GraphClass>(id));
    if (rank != colored_graph::kForbidden) groups[rank].push_back(id);
  }
  tree_abstraction::InformationTerm ranks{"ranks", 1, {}};
  for (const std::vector<int>& group : groups)
    if (!group.empty()) ranks.groups.push_back(group);
  semantic_octree::AbstractionOptions options;
  options.blockSize = 3.2;
  options.weights.terms = {ranks};
  // Above tree_abstraction::kAlpha: cells only place a roadmap's vertices, edges are checked by
  // voxels.
  options.weights.alpha = 0.005;
  return options;
}

}  // namespace semantic_planning
