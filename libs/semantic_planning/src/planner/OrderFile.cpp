#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/StrictYaml.h>

#include <stdexcept>

namespace semantic_planning {

using colored_graph::ClassOrder;
using semantic_types::ClassTable;
using strict_files::StrictYaml;
using OrderId = colored_graph::GraphClass;

namespace {

OrderId classNamed(const StrictYaml& yaml, const YAML::Node& node, const ClassTable& classes) {
  const std::string name = yaml.text(node, "a class");
  if (const auto id = classes.find(name)) return *id;
  if (name == kUnknownGround) return semantic_types::kNoClass;
  yaml.fail(node, "the map has no class '" + name + "'");
}

/** One class, or a list of them. */
std::vector<OrderId> readRank(const StrictYaml& yaml, const YAML::Node& node,
                              const ClassTable& classes) {
  if (node.IsScalar()) return {classNamed(yaml, node, classes)};
  yaml.checkList(node, "best_to_worst");
  std::vector<OrderId> rank;
  for (const YAML::Node& name : node) rank.push_back(classNamed(yaml, name, classes));
  return rank;
}

std::vector<Eigen::Vector2d> readFootprint(const StrictYaml& yaml, const YAML::Node& node) {
  yaml.checkList(node, "footprint");
  std::vector<Eigen::Vector2d> corners;
  for (const YAML::Node& corner : node) {
    if (!corner.IsSequence() || corner.size() != 2) yaml.fail(corner, "footprint: expected [x, y]");
    corners.emplace_back(yaml.number(corner[0], "footprint"), yaml.number(corner[1], "footprint"));
  }
  return corners;
}

}  // namespace

ClassOrder loadClassOrder(const std::filesystem::path& file, const ClassTable& classes) {
  const StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), {"best_to_worst"});
  const YAML::Node list = yaml.required(yaml.root(), "best_to_worst");
  yaml.checkList(list, "best_to_worst");
  std::vector<std::vector<OrderId>> ranks;
  for (const YAML::Node& rank : list) ranks.push_back(readRank(yaml, rank, classes));
  try {
    return ClassOrder(classes.size() + 1, ranks);
  } catch (const std::invalid_argument& e) {
    yaml.fail(list, e.what());
  }
}

VehicleOptions loadVehicle(const std::filesystem::path& file) {
  const StrictYaml yaml(file);
  yaml.checkKeys(yaml.root(), {"footprint", "height", "turning_radius", "clearance", "step_height",
                               "max_slope", "wheel_track"});
  VehicleOptions vehicle;
  const auto number = [&](const char* key, double& value) {
    if (const YAML::Node node = yaml.root()[key]) value = yaml.number(node, key);
  };
  if (const YAML::Node node = yaml.root()["footprint"])
    vehicle.footprint = readFootprint(yaml, node);
  number("height", vehicle.height);
  number("turning_radius", vehicle.turningRadius);
  number("clearance", vehicle.clearance);
  number("step_height", vehicle.stepHeight);
  number("max_slope", vehicle.maxSlope);
  number("wheel_track", vehicle.wheelTrack);
  try {
    vehicle.validate();
  } catch (const std::invalid_argument& e) {
    yaml.fail(yaml.root(), e.what());
  }
  return vehicle;
}

}  // namespace semantic_planning
