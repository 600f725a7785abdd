#include "Mapper.h"

#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/CompressedObstacles.h>
#include <semantic_planning/planner/OrderAbstraction.h>
#include <semantic_types/ClassTableFile.h>
#include <synthetic_world/Classes.h>

#include <utility>

#include "measuring/Stopwatch.h"

namespace simulated_drive {

using colored_graph::ClassOrder;
using measuring::Stopwatch;
using semantic_octree::Abstraction;
using semantic_octree::KeyframeMap;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

SemanticOcTree& prepared(SemanticOcTree& map, const DriveConfig& config, const ClassOrder& order) {
  if (!config.halfLives.empty()) map.setHalfLives(semantic_types::loadClassTable(config.halfLives));
  setAbstraction(
      map, semantic_planning::abstractionFor(order, config.focus.alpha, config.focus.obstacles));
  return map;
}

}  // namespace

Mapper::Mapper(const DriveConfig& config, const ClassOrder& order)
    : Mapper(config, order,
             std::make_unique<StoredMap>(
                 SemanticOcTree(config.voxelSize, synthetic_world::classTable(), config.filter))) {
  if (!config.pose.isExact() && config.pose.correct)
    m_keyframes = std::make_unique<KeyframeMap>(m_map, std::filesystem::temp_directory_path());
}

Mapper::Mapper(const DriveConfig& config, const ClassOrder& order, std::unique_ptr<StoredMap> map)
    : m_config(config),
      m_stored(std::move(map)),
      m_map(prepared(m_stored->tree(), config, order)),
      m_follower(m_map),
      m_planner(m_map, order, config.planner) {}

/** The robot begins where it has room: there is ground below its footprint and around it, as far as
 * the planner wants to know. Its sensors do not see that near: it has the class of what
 * they see on both sides (GroundOptions::unknownGap), if that is one, otherwise whatever class. */
void Mapper::standOn(const Eigen::Isometry3d& T_map_robot) {
  const semantic_planning::VehicleOptions& vehicle = m_config.planner.vehicle;
  const double room = vehicle.clearance + m_config.voxelSize, step = m_config.voxelSize / 2;
  constexpr double kBelow = 1e-3;  // m: in the voxel that holds the ground
  const semantic_planning::Ground& ground = m_planner.ground();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : vehicle.footprint) box.extend(corner);
  semantic_types::LabeledCloud cloud;
  for (double x = box.min().x() - room; x < box.max().x() + room; x += step)
    for (double y = box.min().y() - room; y < box.max().y() + room; y += step) {
      const Eigen::Vector3d below(x, y, -kBelow), p = T_map_robot * below;
      const auto* known =
          ground.near(ground.columnAt(p.x(), p.y()), ground.keyOf(p.z()), ground.step());
      cloud.points.push_back(below.cast<float>());
      cloud.classes.push_back(known ? known->classId : semantic_types::kNoClass);
    }
  semantic_octree::InsertionOptions noRays;
  noRays.carvingMargin = 1e3;
  if (m_keyframes)
    m_keyframes->insert(cloud, Eigen::Isometry3d::Identity(), noRays);  // the first is at the robot
  else
    m_map.insert(cloud, T_map_robot, noRays);
  m_planner.update();
}

semantic_planning::StageTimes Mapper::insert(const std::vector<Observation>& seen,
                                             const Eigen::Isometry3d& T_map_robot) {
  Stopwatch watch(measuring::TimeOf::Thread);
  for (const Observation& o : seen)
    m_map.insert(o.cloud, T_map_robot * o.T_robot_sensor, m_config.insertion);
  semantic_planning::StageTimes times{{"insert", watch.lap()}};
  m_planner.update();
  if (!std::exchange(m_stands, true)) standOn(T_map_robot);
  times.emplace_back("update", watch.lap());
  return times;
}

semantic_planning::StageTimes Mapper::insert(const std::vector<Observation>& seen,
                                             const semantic_slam::Slam::Added& added,
                                             const semantic_slam::Slam& slam) {
  constexpr double kOff = 0.25;  // voxels
  constexpr int kLeftOut = 2;    // scans, at most, that begin no keyframe
  Stopwatch watch(measuring::TimeOf::Thread);
  if (m_keyframes && added.keyframe == m_keyframes->numKeyframes())
    m_keyframes->begin(slam.poses().back());
  if (added.isNew || ++m_leftOut > kLeftOut) {
    m_leftOut = 0;
    for (const Observation& o : seen) {
      const Eigen::Isometry3d T = added.T_keyframe_robot * o.T_robot_sensor;
      if (m_keyframes)
        m_keyframes->insert(o.cloud, T, m_config.insertion);
      else
        m_map.insert(o.cloud, slam.poses().back() * T, m_config.insertion);
    }
  }
  if (m_keyframes && added.posesMoved)
    m_keyframes->move(posesOff(slam, *m_keyframes, kOff * m_config.voxelSize));
  semantic_planning::StageTimes times{{"insert", watch.lap()}};
  m_planner.update();
  if (!std::exchange(m_stands, true)) standOn(slam.poses().back() * added.T_keyframe_robot);
  times.emplace_back("update", watch.lap());
  return times;
}

void Mapper::focus(const std::vector<semantic_octree::Region>& regions) {
  Abstraction(m_map).setRegions(regions);
}

SemanticOcTree Mapper::compressed() { return Abstraction(m_map).compressedMap(); }

std::size_t Mapper::numCompressedLeaves() { return m_follower.skipLeaves(); }

semantic_driving::ObstaclePoints Mapper::obstacles(const mrpt::math::TPose2D& pose, double z,
                                                   const semantic_driving::ObstacleOptions& options,
                                                   bool ofFullTree) {
  if (ofFullTree) return senseObstacles(m_planner, pose, z, options);
  return senseCompressedObstacles(m_planner, Abstraction(m_map), pose, z, options);
}

}  // namespace simulated_drive
