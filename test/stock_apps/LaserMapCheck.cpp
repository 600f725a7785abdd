#include "LaserMapCheck.h"

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace {

using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;

/** Where the scanner of mrpt-common's robot sits, m ahead and above. */
constexpr double kAhead = 0.78, kAbove = 0.3;

std::vector<std::vector<double>> readTable(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double number; words >> number;) row.push_back(number);
    if (row.size() >= 3) rows.push_back(row);
  }
  return rows;
}

using Place = std::array<int, 2>;

Place placeOf(const SemanticOcTree& map, double x, double y) {
  const double size = map.getResolution();
  return {int(std::floor(x / size)), int(std::floor(y / size))};
}

bool isNear(const std::set<Place>& places, const Place& p) {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      if (places.count({p[0] + dx, p[1] + dy})) return true;
  return false;
}

double shareNear(const std::set<Place>& some, const std::set<Place>& of) {
  double count = 0;
  for (const Place& p : of) count += isNear(some, p);
  return of.empty() ? 0 : count / double(of.size());
}

std::set<Place> occupiedPlaces(const SemanticOcTree& map) {
  std::set<Place> places;
  for (auto it = map.begin_leafs(), end = map.end_leafs(); it != end; ++it)
    if (map.isNodeOccupied(*it)) places.insert(placeOf(map, it.getX(), it.getY()));
  return places;
}

}  // namespace

LaserMapCheck checkLaserMap(const SemanticOcTree& map, const std::filesystem::path& points,
                            const std::filesystem::path& path) {
  std::set<Place> seen;
  for (const auto& row : readTable(points)) seen.insert(placeOf(map, row[0], row[1]));
  const auto occupied = occupiedPlaces(map);
  LaserMapCheck result;
  result.pointsInOccupied = shareNear(occupied, seen);
  result.occupiedAtPoints = shareNear(seen, occupied);
  const auto poses = readTable(path);
  for (const auto& pose : poses)
    result.pathInFree += map.query(pose[1] + kAhead * std::cos(pose[3]),
                                   pose[2] + kAhead * std::sin(pose[3]), kAbove)
                             .status == CellState::Status::Free;
  result.pathInFree /= double(std::max<std::size_t>(1, poses.size()));
  return result;
}
