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

class RankReader {
 public:
  RankReader(const StrictYaml& yaml, const ClassTable& classes)
      : m_yaml(yaml), m_classes(classes) {}

  /** One class, or a list of them. */
  std::vector<OrderId> read(const YAML::Node& node) {
    if (node.IsScalar()) return {classNamed(node)};
    m_yaml.checkList(node, "best_to_worst");
    std::vector<OrderId> rank;
    for (const YAML::Node& name : node) rank.push_back(classNamed(name));
    return rank;
  }

 private:
  OrderId classNamed(const YAML::Node& node) {
    const std::string name = m_yaml.text(node, "a class");
    const auto id = m_classes.find(name);
    if (!id && name != kUnknownGround) m_yaml.fail(node, "the map has no class '" + name + "'");
    if (!m_named.insert(name).second) m_yaml.fail(node, "'" + name + "' is named twice");
    return id.value_or(semantic_types::kNoClass);
  }

  const StrictYaml& m_yaml;
  const ClassTable& m_classes;
  std::set<std::string> m_named;
};

double readRate(const StrictYaml& yaml, const YAML::Node& node) {
  if (node.IsScalar() && node.Scalar() == "inf") return std::numeric_limits<double>::infinity();
  return yaml.number(node, "rates");
}

ClassOrder readOrder(const StrictYaml& yaml, const ClassTable& classes, const YAML::Node& list) {
  yaml.checkList(list, "best_to_worst");
  std::vector<std::vector<OrderId>> ranks;
  RankReader reader(yaml, classes);
  for (const YAML::Node& rank : list) ranks.push_back(reader.read(rank));
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
