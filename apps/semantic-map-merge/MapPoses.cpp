#include "MapPoses.h"

#include <strict_files/TextFile.h>

#include <array>
#include <sstream>
#include <stdexcept>

#include "poses/Poses.h"

namespace semantic_map_merge {

namespace fs = std::filesystem;

namespace {

struct Line {
  std::string map;
  Eigen::Isometry3d pose;
};

Line parse(const std::string& text) {
  std::istringstream in(text);
  const strict_files::ClassicNumbers classic(in);
  Line line;
  std::array<double, 6> v{};
  std::string rest;
  in >> line.map;
  for (double& value : v) in >> value;
  if (!in || in >> rest)
    throw std::runtime_error("'" + text + "', expected MAP x y z yaw pitch roll");
  line.pose = poses::poseOfNumbers(v);
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
  std::map<fs::path, Eigen::Isometry3d> poses;
  for (const strict_files::TextLine& line : strict_files::readLines(file)) {
    try {
      addLine(line.text, maps, poses);
    } catch (const std::exception& e) {
      throw std::runtime_error(line.where + ": " + e.what());
    }
  }
  return poses;
}

}  // namespace semantic_map_merge
