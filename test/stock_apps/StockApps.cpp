#include "StockApps.h"

#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <semantic_octree/TreeFile.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace fs = std::filesystem;

const std::string StockApps::kPlugin = std::string(MSO_LIB_DIR) + "/libmrpt_semantic_octree.so";

StockApps::StockApps() {
  for (const char* name : {"config", "rawlog-samples"})
    fs::create_directory_symlink(fs::path(MSO_SOURCE_DIR) / name, folder / name);
}

ProgramRun StockApps::run(const std::string& command, Plugin plugin) const {
  const std::string environment =
      plugin == Plugin::Preloaded ? "LD_PRELOAD='" + kPlugin + "' " : std::string();
  folder.write("command", "cd '" + folder.path().string() + "'\nexport HOME=\"$PWD\"\n" +
                              environment + command + "\n");
  return runCommand("timeout 200 sh '" + (folder / "command").string() + "'");
}

std::optional<semantic_octree::SemanticOcTree> StockApps::mapIn(
    const std::string& subfolder) const {
  if (!fs::exists(folder / subfolder)) return std::nullopt;
  for (const auto& file : fs::recursive_directory_iterator(folder / subfolder))
    if (file.path().extension() == ".semantic")
      return semantic_octree::loadTree(file.path().string());
  return std::nullopt;
}

std::string StockApps::shortRawlog(const std::string& dataset, std::size_t pairs) const {
  using Entry = mrpt::obs::CRawlog::TEntryType;
  mrpt::obs::CRawlog rawlog, first;
  EXPECT_TRUE(rawlog.loadFromRawLogFile("/usr/share/mrpt/datasets/" + dataset));
  for (std::size_t entry = 0; pairs > 0; ++entry) {
    const auto type = rawlog.getType(entry);
    if (type == Entry::etActionCollection) first.insert(rawlog.getAsAction(entry));
    if (type != Entry::etSensoryFrame) continue;
    first.insert(rawlog.getAsObservations(entry));
    --pairs;
  }
  const std::string file = (folder / "short.rawlog").string();
  EXPECT_TRUE(first.saveToRawLogFile(file));
  return file;
}

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

mrpt::maps::CSimpleMap villageFrames(std::size_t count) {
  labeled_cloud::RawlogReader rawlog(std::string(MSO_SOURCE_DIR) +
                                     "/rawlog-samples/village.rawlog");
  mrpt::maps::CSimpleMap frames;
  mrpt::obs::CSensoryFrame::Ptr frame;
  while (const auto entry = rawlog.next())
    for (const auto& observation : entry->observations) {
      const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(observation);
      if (!pose) {
        frame->insert(observation);
        continue;
      }
      if (frames.size() == count) return frames;
      frame = mrpt::obs::CSensoryFrame::Create();
      frames.insert(mrpt::poses::CPose3DPDFGaussian::Create(pose->pose), frame);
    }
  return frames;
}
