#include "SpaceOptions.h"

#include <map>
#include <stdexcept>

namespace semantic_map_compress {

using semantic_octree::AbstractionOptions;
using semantic_octree::Region;
using strict_files::StrictYaml;

namespace {

void readShape(const StrictYaml& yaml, const YAML::Node& node, Region& region) {
  if (node["box"].IsDefined() + node["sphere"].IsDefined() + node["corridor"].IsDefined() != 1)
    yaml.fail(node, "region: expected one of box, sphere, corridor");
  if (node["sphere"]) {
    region.shape = Region::Shape::Sphere;
    region.a = yaml.point(node["sphere"], "sphere");
    return;
  }
  const bool isBox = node["box"].IsDefined();
  region.shape = isBox ? Region::Shape::Box : Region::Shape::Corridor;
  const std::string field = isBox ? "box" : "corridor";
  const YAML::Node ends = node[field];
  if (!ends.IsSequence() || ends.size() != 2) yaml.fail(ends, field + ": expected two points");
  region.a = yaml.point(ends[0], field);
  region.b = yaml.point(ends[1], field);
}

Region readRegion(const StrictYaml& yaml, const YAML::Node& node) {
  yaml.checkKeys(node, {"box", "sphere", "corridor", "radius", "weight"});
  Region region;
  readShape(yaml, node, region);
  if (node["radius"].IsDefined() == (region.shape == Region::Shape::Box))
    yaml.fail(node, "region: a sphere or corridor has a radius, a box has none");
  if (node["radius"]) region.radius = yaml.number(node["radius"], "radius");
  region.weight = yaml.notNegative(yaml.required(node, "weight"), "weight of a region");
  try {
    region.validate();
  } catch (const std::invalid_argument& e) {
    yaml.fail(node, e.what());
  }
  return region;
}

}  // namespace

const std::set<std::string>& spaceKeys() {
  static const std::set<std::string> keys = {"block_size", "unknown", "unknown_weight", "frame",
                                             "regions"};
  return keys;
}

AbstractionOptions readSpace(const StrictYaml& yaml) {
  using Unknown = AbstractionOptions::Unknown;
  using Frame = AbstractionOptions::Frame;
  const YAML::Node& root = yaml.root();
  AbstractionOptions space;
  if (const YAML::Node size = root["block_size"])
    space.blockSize = yaml.notNegative(size, "block_size");
  if (const YAML::Node unknown = root["unknown"])
    space.unknown = yaml.choice<Unknown>(unknown, "unknown",
                                         {{"own_class", Unknown::OwnClass},
                                          {"uniform", Unknown::Uniform},
                                          {"prior", Unknown::Prior}});
  if (const YAML::Node weight = root["unknown_weight"]) {
    space.unknownWeight = yaml.notNegative(weight, "unknown_weight");
    if (space.unknownWeight > 1)
      yaml.fail(weight, "unknown_weight: expected 0 to 1, found " + weight.Scalar());
  }
  if (const YAML::Node frame = root["frame"])
    space.frame =
        yaml.choice<Frame>(frame, "frame", {{"free", Frame::Free}, {"charged", Frame::Charged}});
  if (const YAML::Node regions = root["regions"]) {
    yaml.checkList(regions, "regions");
    for (const auto& region : regions) space.regions.push_back(readRegion(yaml, region));
  }
  return space;
}

}  // namespace semantic_map_compress
