#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_types/ClassTable.h>

#include "Scene.h"

namespace insertion_benchmark {
namespace {

Eigen::Isometry3d isometryOf(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    T.translation()[row] = pose[row];
    for (int column = 0; column < 3; ++column)
      T.linear()(row, column) = pose.getRotationMatrix()(row, column);
  }
  return T;
}

}  // namespace

Scene readRawlog(const std::filesystem::path& file, const std::filesystem::path& classes,
                 std::size_t maxScans) {
  const semantic_types::ClassTable table = semantic_types::loadClassTable(classes);
  const labeled_cloud::Trajectory trajectory = labeled_cloud::readTrajectory({file});
  labeled_cloud::ScanConverter converter(table);
  labeled_cloud::RawlogReader reader(file);
  Scene scene;
  scene.numClasses = table.size();
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) {
      if (maxScans > 0 && scene.scans.size() == maxScans) return scene;
      const auto T_map_robot = trajectory.at(observation->timestamp);
      if (!T_map_robot || !labeled_cloud::ScanConverter::accepts(*observation)) continue;
      const auto scan = converter.convert(*observation);
      scene.scans.push_back({scan->cloud, isometryOf(*T_map_robot + scan->T_robot_sensor)});
    }
  return scene;
}

}  // namespace insertion_benchmark
