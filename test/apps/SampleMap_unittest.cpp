#include <gtest/gtest.h>
#include <labeled_cloud/ClassTableFile.h>
#include <labeled_cloud/RawlogReader.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_octree/TreeFile.h>

#include <nlohmann/json.hpp>

#include "MapQuality.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

namespace {

const fs::path kSources = MSO_SOURCE_DIR;

/** The LiDAR scans of the sample at their true poses. */
std::vector<LabeledFrame> readSampleScans() {
  const auto table = labeled_cloud::loadClassTable(kSources / "config/classes/synthetic.yaml");
  const auto poses = labeled_cloud::loadTumTrajectory(kSources / "rawlog-samples/village.tum");
  labeled_cloud::ScanConverter converter(table);
  labeled_cloud::RawlogReader reader(kSources / "rawlog-samples/village.rawlog");
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
  const ProgramRun run = runProgram(
      "rawlog2semantic-map",
      {"--config", (kSources / "config/rawlog2semantic-map/synthetic.ini").string(), "--output",
       folder.path().string(), (kSources / "rawlog-samples/village.rawlog").string()});
  ASSERT_EQ(run.status, 0) << run.errors;

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
