#include <semantic_planning/vehicle/VehicleOptions.h>

#include <strict_files/StrictYaml.h>

#include <stdexcept>

namespace semantic_planning {

using strict_files::above;
using strict_files::atLeast;

void VehicleOptions::describe(strict_files::OptionList& list) {
  strict_files::Range weights = atLeast(1);
  weights.withInfinity = true;
  list.add("height", height, "m", above(0), "from the ground to the top");
  list.add("turning_radius", turningRadius, "m", above(0),
           "least radius of the origin's planned path; drives correct with down to 0.75 of it");
  list.add("clearance", clearance, "m", atLeast(0), "kept free around the footprint");
  list.add("step_height", stepHeight, "m", atLeast(0), "highest step that the wheels take");
  list.add("max_slope", maxSlope, "degrees", strict_files::between(0, 89), "steepest ground");
  list.add("wheel_track", wheelTrack, "m", atLeast(0),
           "between left and right wheels, whose classes count; 0: one track in the middle");
  list.add("reverse_weight", reverseWeight, "", weights,
           "what a meter backwards counts; inf: it only drives forward");
  list.add("gear_change", gearChange, "m", atLeast(0), "what a change of gear counts");
}

void VehicleOptions::validate() const { strict_files::checkOptions(*this, "VehicleOptions"); }

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
  const auto list = strict_files::OptionList::of(vehicle);
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
