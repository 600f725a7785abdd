#include "ConvertedScans.h"

#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/Trajectory.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <set>

#include "TemporaryFolder.h"

using namespace labeled_cloud;
using semantic_types::ClassId;
using semantic_types::ClassTable;
namespace fs = std::filesystem;

ProgramRun dataset2rawlog(const std::string& arguments) {
  return runCommand(std::string(MSO_BIN_DIR) + "/dataset2rawlog " + arguments);
}

std::string failureOf(const std::string& arguments) {
  const ProgramRun result = dataset2rawlog(arguments);
  EXPECT_NE(result.status, 0) << result.output;
  EXPECT_TRUE(contains(result.output, "dataset2rawlog: "));
  return result.output;
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

fs::path shippedTable(const std::string& name) {
  return fs::path(MSO_SOURCE_DIR) / "config/classes" / name;
}

Eigen::Vector3d PosedScan::inMap(std::size_t i) const {
  const auto T =
      (T_map_robot + scan.T_robot_sensor).getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
  return (T.asEigen() * scan.cloud.points[i].cast<double>().homogeneous()).head<3>();
}

std::vector<PosedScan> readScans(const fs::path& rawlog, const ClassTable& table,
                                 std::shared_ptr<ImageLabeler> labeler) {
  const Trajectory trajectory = readTrajectory({rawlog});
  ScanConverter converter(table, {}, labeler);
  RawlogReader reader(rawlog);
  std::vector<PosedScan> scans;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations)
      if (auto scan = converter.convert(*observation)) {
        const auto pose = trajectory.at(scan->timestamp);
        EXPECT_TRUE(pose);
        scans.push_back({std::move(*scan), *pose});
      }
  return scans;
}

std::vector<PosedScan> convertAndRead(const std::string& arguments, const fs::path& rawlog,
                                      const ClassTable& table) {
  const ProgramRun result = dataset2rawlog(arguments + " -f -o " + quoted(rawlog));
  EXPECT_EQ(result.status, 0) << result.output;
  if (result.status != 0) return {};
  return readScans(rawlog, table);
}

double agreement(const std::vector<PosedScan>& scans, double resolution) {
  struct Voxel {
    std::map<ClassId, std::size_t> votes;
    std::set<std::size_t> seenBy;
  };
  std::map<std::array<int, 3>, Voxel> voxels;
  for (std::size_t s = 0; s < scans.size(); ++s)
    for (std::size_t i = 0; i < scans[s].scan.cloud.size(); ++i) {
      if (scans[s].scan.cloud.classes[i] == 0) continue;
      const Eigen::Vector3i key = (scans[s].inMap(i) / resolution).array().floor().cast<int>();
      Voxel& voxel = voxels[{key.x(), key.y(), key.z()}];
      ++voxel.votes[scans[s].scan.cloud.classes[i]];
      voxel.seenBy.insert(s);
    }
  std::size_t agreeing = 0, all = 0;
  for (const auto& [key, voxel] : voxels) {
    if (voxel.seenBy.size() < 2) continue;
    std::size_t most = 0;
    for (const auto& [id, votes] : voxel.votes) most = std::max(most, votes), all += votes;
    agreeing += most;
  }
  return static_cast<double>(agreeing) / all;
}

const char* const kThreeClasses =
    "no_class: [0]\n"
    "classes:\n"
    "  - {id: 1, name: road, color: [255, 0, 0], raw: [40]}\n"
    "  - {id: 2, name: grass, color: [0, 255, 0], raw: [70]}\n"
    "  - {id: 3, name: car, color: [0, 0, 255], raw: [10, 252]}\n";
