#include "MapPoses.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "../semantic-map-edit/PoseOfNumbers.h"

namespace semantic_map_merge {

namespace fs = std::filesystem;

namespace {

struct Line {
  std::string map;
  Eigen::Isometry3d pose;
};

Line parse(const std::string& text) {
  std::istringstream in(text);
  Line line;
  std::array<double, 6> v{};
  std::string rest;
  in >> line.map;
  for (double& value : v) in >> value;
  if (!in || in >> rest)
    throw std::runtime_error("'" + text + "', expected MAP x y z yaw pitch roll");
  line.pose = semantic_map_edit::poseOfNumbers(v);
  return line;
}

fs::path mapNamed(const fs::path& name, const std::vector<fs::path>& maps) {
  std::vector<fs::path> matches;
  for (const fs::path& map : maps)
    if (map == name || map.filename() == name) matches.push_back(map);
  if (matches.size() == 1) return matches.front();
  throw std::runtime_error("'" + name.string() + "' is " + (matches.empty() ? "none" : "several") +
                           " of the maps to merge");
}

void addLine(const std::string& text, const std::vector<fs::path>& maps,
             std::map<fs::path, Eigen::Isometry3d>& poses) {
  const Line line = parse(text);
  if (!poses.emplace(mapNamed(line.map, maps), line.pose).second)
    throw std::runtime_error("'" + line.map + "' has a pose already");
}

}  // namespace

std::map<fs::path, Eigen::Isometry3d> readMapPoses(const fs::path& file,
                                                   const std::vector<fs::path>& maps) {
  std::ifstream in(file);
  if (!in || fs::is_directory(file)) throw std::runtime_error(file.string() + ": cannot be read");
  std::map<fs::path, Eigen::Isometry3d> poses;
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    text.erase(std::min(text.find('#'), text.size()));
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      addLine(text, maps, poses);
    } catch (const std::exception& e) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  return poses;
}

}  // namespace semantic_map_merge
