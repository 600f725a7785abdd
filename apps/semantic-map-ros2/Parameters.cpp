#include "Parameters.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <strict_files/IniSection.h>
#include <strict_files/StrictYaml.h>
#include <strict_files/Words.h>

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

namespace semantic_map_ros2 {

namespace fs = std::filesystem;
using strict_files::OptionList;

void NodeOptions::describe(OptionList& list) {
  using strict_files::atLeast;
  list.add(
      "class_field", classField, "",
      "field of clouds that holds classes: raw ids of the class table, or `rgb`: colors of it");
  list.add("map_frame", mapFrame, "", "frame of the map, of goals, paths and grids");
  list.add("odom_frame", odomFrame, "", "with `slam`: the frame in which odometry has the robot");
  list.add("base_frame", baseFrame, "", "frame of the robot, anywhere on it");
  list.add("use_sim_time", useSimTime, "", "time is what /clock says");
  list.add(
      "slam", slam, "",
      "scans are registered to each other, loops closed, and the transform from `map_frame` to "
      "`odom_frame` is published; without, /tf has the robot in `map_frame`");
  list.add("drive", drive, "", "the robot drives to goals: `cmd_vel`");
  list.add("transform_timeout", transformTimeout, "s", atLeast(0),
           "how long a scan waits for its transforms and labels until it is left out");
  list.add("publish_period", publishPeriod, "s", atLeast(0),
           "the map is published no more often; 0: after each scan");
  list.add("order", order, "", "order of classes (YAML), for `map` and `plan`; empty: neither");
  list.add(
      "costs", costs, "",
      "occupancy of each rank in `map`, 0 to 100, with commas between; empty: evenly from 0 to 90");
}

void NodeOptions::validate() const { strict_files::checkOptions(*this, "NodeOptions"); }

std::vector<int> NodeOptions::costsOf(int ranks) const {
  if (costs.empty()) return {};
  std::vector<int> all;
  std::istringstream words(costs);
  for (std::string word; std::getline(words, word, ',');) {
    const double cost = strict_files::numberOf(strict_files::trimmed(word));
    if (!(cost >= 0 && cost <= 100) || cost != std::floor(cost))
      throw std::invalid_argument("costs: '" + word + "' is no whole number from 0 to 100");
    all.push_back(static_cast<int>(cost));
  }
  if (all.size() != static_cast<std::size_t>(ranks))
    throw std::invalid_argument("costs: there are " + std::to_string(all.size()) +
                                ", expected one for each of " + std::to_string(ranks) + " ranks");
  return all;
}

namespace {

const std::string kNode = "ros__parameters";  // as messages call those without a section
const std::set<std::string> kFiles = {"order", "map.classes", "planner.vehicle", "drive.reactive"};

/** Parameters as sections of an .ini file. */
using Source = mrpt::config::CConfigFileMemory;

void set(Source& source, const std::string& name, const std::string& value,
         const fs::path& folder) {
  const bool isFile = kFiles.count(name) > 0 && !value.empty();
  const std::size_t dot = name.find('.');
  const std::string section = dot == std::string::npos ? kNode : name.substr(0, dot);
  source.write(section, name.substr(dot == std::string::npos ? 0 : dot + 1),
               isFile ? (folder / value).lexically_normal().string() : value);
}

/** Nested maps are sections. */
void addAll(const strict_files::StrictYaml& yaml, const YAML::Node& map, const std::string& prefix,
            const fs::path& folder, Source& source) {
  yaml.checkMap(map);
  for (const auto& entry : map) {
    const std::string name = prefix + yaml.text(entry.first, "parameter");
    std::string value;
    if (entry.second.IsMap()) {
      if (!prefix.empty()) yaml.fail(entry.second, name + ": a section within a section");
      addAll(yaml, entry.second, name + ".", folder, source);
      continue;
    }
    if (entry.second.IsSequence())
      for (const auto& element : entry.second)
        value += (value.empty() ? "" : ", ") + yaml.text(element, name);
    else if (!entry.second.IsNull())
      value = yaml.text(entry.second, name);
    set(source, name, value, folder);
  }
}

/** Takes from a file for many nodes what is for all and for this one. */
void addFile(const fs::path& file, Source& source) {
  const strict_files::StrictYaml yaml(file);
  yaml.checkMap(yaml.root());
  bool isOfRos = false;
  for (const auto& node : yaml.root()) {
    if (!node.second.IsMap() || !node.second["ros__parameters"]) continue;
    isOfRos = true;
    const std::string name = yaml.text(node.first, "node");
    if (name == "/**" || name == "semantic_map" || name == "/semantic_map")
      addAll(yaml, node.second["ros__parameters"], "", file.parent_path(), source);
  }
  if (!isOfRos) addAll(yaml, yaml.root(), "", file.parent_path(), source);
}

Parameters read(const Source& source) {
  Parameters p;
  strict_files::checkSections(source, {kNode, "map", "insertion", "abstraction", "slam", "planner",
                                       "drive", "guide", "movers", "focus", "explore"});
  strict_files::readSection(source, kNode, p.node);
  strict_files::readSection(source, "map", p.map);
  strict_files::readSection(source, "insertion", p.insertion);
  strict_files::readSection(source, "abstraction", p.abstraction);
  strict_files::readSection(source, "slam", p.slam);
  readSections(source, {}, {}, p.navigation);
  if (p.node.drive && (p.node.order.empty() || p.navigation.reactive.empty()))
    throw std::runtime_error("drive: expected order and drive.reactive, too");
  return p;
}

}  // namespace

semantic_slam::MapperOptions Parameters::mapping() const {
  semantic_slam::MapperOptions mapping;
  mapping.insertion = insertion.scan;
  mapping.localize = node.slam;
  mapping.slam = slam;
  if (node.slam) mapping.scans = fs::temp_directory_path();
  return mapping;
}

semantic_octree::SemanticOcTree Parameters::newMap() const {
  const auto table = map.classes.empty() ? semantic_map::CSemanticOctoMap::occupancyOnly()
                                         : semantic_types::loadClassTable(map.classes);
  semantic_octree::SemanticOcTree tree(map.resolution, table, insertion.filter);
  abstract(tree);
  return tree;
}

void Parameters::abstract(semantic_octree::SemanticOcTree& tree) const {
  if (abstraction.isSet()) setAbstraction(tree, abstraction);
}

Parameters readParameters(const std::vector<fs::path>& files,
                          const std::vector<std::pair<std::string, std::string>>& values) {
  Source source;
  for (const fs::path& file : files) addFile(file, source);
  for (const auto& [name, value] : values) set(source, name, value, "");
  return read(source);
}

}  // namespace semantic_map_ros2
