#include <gtest/gtest.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

#include "LabeledFrame.h"
#include "MapQuality.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

namespace {

/** The LiDAR scans of the shipped sample at their true poses. */
std::vector<LabeledFrame> readSampleScans() {
  const fs::path sources = MSO_SOURCE_DIR;
  const auto table = semantic_types::loadClassTable(sources / "config/classes/synthetic.yaml");
  const auto poses = labeled_cloud::loadTumTrajectory(sources / "rawlog-samples/village.tum");
  labeled_cloud::ScanConverter converter(table);
  labeled_cloud::RawlogReader reader(sources / "rawlog-samples/village.rawlog");
  std::vector<LabeledFrame> frames;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) {
      if (observation->sensorLabel != "LIDAR") continue;
      const auto scan = converter.convert(*observation);
      const auto pose = *poses.at(observation->timestamp) + scan->T_robot_sensor;
      frames.push_back({scan->cloud, Eigen::Isometry3d::Identity(), {}});
      frames.back().T_map_sensor.matrix() =
          pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
    }
  return frames;
}

}  // namespace

TEST(SampleMap, theVillageIsMappedWithItsClasses) {
  const TemporaryFolder folder;
  const fs::path sources = MSO_SOURCE_DIR;
  succeeded(
      runProgram("rawlog2semantic-map",
                 {"--config", (sources / "config/maps/synthetic.ini").string(), "--output",
                  folder.path().string(), (sources / "rawlog-samples/village.rawlog").string()}));

  const auto summary = nlohmann::json::parse(folder.read("summary.json"));
  EXPECT_EQ(summary["observations"]["inserted"], 48);
  for (const char* name : {"road", "sidewalk", "grass", "canopy", "building", "roof"})
    EXPECT_GT(summary["map"]["voxelsPerClass"][name], 500) << name;

  const auto map = semantic_octree::loadTree((folder / "map.semantic").string());
  MapQuality quality;
  for (const LabeledFrame& frame : readSampleScans()) judge(map, frame, 25, quality);
  EXPECT_GT(quality.coverage(), 0.95);
  EXPECT_GT(quality.accuracy(), 0.93);  // 2 % of the labels are wrong
}
