#include <semantic_planning/vehicle/VehicleOptions.h>
#include <strict_files/StrictYaml.h>

#include <stdexcept>

namespace semantic_planning {

using strict_files::StrictYaml;

namespace {

Footprint readFootprint(const StrictYaml& yaml, const YAML::Node& node) {
  yaml.checkList(node, "footprint");
  std::vector<Eigen::Vector2d> corners;
  for (const YAML::Node& corner : node) {
    if (!corner.IsSequence() || corner.size() != 2) yaml.fail(corner, "footprint: expected [x, y]");
    corners.emplace_back(yaml.number(corner[0], "footprint"), yaml.number(corner[1], "footprint"));
  }
  try {
    return Footprint(corners);
  } catch (const std::invalid_argument& e) {
    yaml.fail(node, e.what());
  }
}

}  // namespace

VehicleOptions loadVehicle(const std::filesystem::path& file) {
  const StrictYaml yaml(file);
  VehicleOptions vehicle;
  strict_files::OptionList list;
  vehicle.describe(list);
  const std::vector<std::string> names = list.names();
  std::set<std::string> known(names.begin(), names.end());
  known.insert("footprint");
  yaml.checkKeys(yaml.root(), known);
  yaml.read(yaml.root(), list);
  if (const YAML::Node node = yaml.root()["footprint"])
    vehicle.footprint = readFootprint(yaml, node);
  return vehicle;
}

}  // namespace semantic_planning
