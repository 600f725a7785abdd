#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <semantic_types/ClassTable.h>

#include "Scene.h"

namespace insertion_benchmark {

std::size_t Scene::numPoints() const {
  std::size_t n = 0;
  for (const PosedScan& scan : scans) n += scan.cloud.size();
  return n;
}

Scene sceneOf(const std::filesystem::path& file, const std::filesystem::path& classes,
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
      scene.scans.push_back(
          {scan->cloud, labeled_cloud::toEigen(*T_map_robot + scan->T_robot_sensor)});
    }
  return scene;
}

}  // namespace insertion_benchmark
