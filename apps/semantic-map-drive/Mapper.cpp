#include "Mapper.h"

#include <semantic_planning/OrderAbstraction.h>
#include <synthetic_world/Classes.h>

#include "Stopwatch.h"

namespace semantic_map_drive {

using colored_graph::ClassOrder;
using semantic_octree::SemanticOcTree;

namespace {

SemanticOcTree withAbstraction(SemanticOcTree map, const ClassOrder& order) {
  map.setAbstraction(semantic_planning::abstractionFor(order));
  return map;
}

}  // namespace

Mapper::Mapper(const DriveConfig& config, const ClassOrder& order)
    : Mapper(config, order,
             SemanticOcTree(config.voxelSize, synthetic_world::classTable(), config.filter)) {}

Mapper::Mapper(const DriveConfig& config, const ClassOrder& order, SemanticOcTree map)
    : m_config(config),
      m_map(withAbstraction(std::move(map), order)),
      m_planner(m_map, order, config.planner) {}

void Mapper::standOn(const Eigen::Isometry3d& T_map_robot) {
  const semantic_planning::VehicleOptions& vehicle = m_config.planner.vehicle;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : vehicle.footprint) box.extend(corner);
  const double step = m_config.voxelSize / 2, below = 1e-3;
  semantic_octree::LabeledCloud cloud;
  for (double x = box.min().x() - vehicle.clearance; x < box.max().x() + vehicle.clearance;
       x += step)
    for (double y = box.min().y() - vehicle.clearance; y < box.max().y() + vehicle.clearance;
         y += step) {
      cloud.points.push_back(Eigen::Vector3d(x, y, -below).cast<float>());
      cloud.classes.push_back(semantic_octree::kNoClass);
    }
  semantic_octree::InsertionOptions noRays;
  noRays.carvingMargin = 1e3;
  m_map.insert(cloud, T_map_robot, noRays);
}

semantic_planning::StageTimes Mapper::insert(const std::vector<Observation>& seen,
                                             const Eigen::Isometry3d& T_map_robot) {
  Stopwatch watch;
  for (const Observation& o : seen)
    m_map.insert(o.cloud, T_map_robot * o.T_robot_sensor, m_config.insertion);
  semantic_planning::StageTimes times{{"insert", watch.milliseconds()}};
  m_planner.update();
  times.emplace_back("update", watch.milliseconds());
  return times;
}

}  // namespace semantic_map_drive
