#include "SampleScans.h"

#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_types/ClassTable.h>

#include <filesystem>

std::vector<LabeledFrame> readSampleScans() {
  const std::filesystem::path sources = MSO_SOURCE_DIR;
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
