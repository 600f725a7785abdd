#include "SimulatedSensors.h"

#include <cmath>

#include "synthetic_rawlog/Observations.h"

namespace simulated_drive {

using semantic_types::LabeledCloud;
using synthetic_world::CameraFrame;
using synthetic_world::CameraOptions;
using synthetic_world::World;

namespace {

Eigen::Isometry3d T_robot_camera(double pitchDegrees) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 0.25, 0, 1.2;
  T.rotate(Eigen::AngleAxisd(pitchDegrees * M_PI / 180, Eigen::Vector3d::UnitY()));
  return T;
}

Eigen::Isometry3d T_robot_lidar() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 0.1, 0, 1.4;
  return T;
}

/** \param emptyAt depth of pixels without a return; 0: these are left out */
LabeledCloud cloudOf(const CameraFrame& frame, const CameraOptions& options, double emptyAt) {
  LabeledCloud cloud;
  for (int row = 0; row < frame.depth.height; ++row)
    for (int column = 0; column < frame.depth.width; ++column) {
      const float seen = frame.depth.at(row, column);
      const double depth = seen > 0 ? seen : emptyAt;
      if (depth <= 0) continue;
      cloud.points.push_back((depth * options.ray(row, column)).cast<float>());
      cloud.classes.push_back(frame.labels.at(row, column));
    }
  return cloud;
}

}  // namespace

std::vector<Observation> SimulatedSensors::sense(const World& world,
                                                 const Eigen::Isometry3d& T_world_robot) {
  ++m_frame;
  std::vector<Observation> seen;
  if (m_config.hasCamera) seen.push_back(camera(world, T_world_robot));
  if (m_config.hasLidar) seen.push_back(lidar(world, T_world_robot));
  return seen;
}

Observation SimulatedSensors::camera(const World& world, const Eigen::Isometry3d& T_world_robot) {
  Observation seen;
  seen.T_robot_sensor = T_robot_camera(m_config.cameraPitch);
  CameraOptions options = m_config.camera;
  options.color = m_keepOriginals;
  const CameraFrame frame =
      renderCamera(world, T_world_robot * seen.T_robot_sensor, options, {m_config.seed, m_frame});
  seen.cloud = cloudOf(frame, options, m_config.emptyCarves ? options.maxRange : 0);
  if (m_config.emptyCarves) seen.emptyFrom = options.maxRange * (1 - 1e-6);  // floats are rounded
  if (m_keepOriginals)
    seen.original = synthetic_rawlog::rangeScan(frame, options, seen.T_robot_sensor);
  return seen;
}

Observation SimulatedSensors::lidar(const World& world, const Eigen::Isometry3d& T_world_robot) {
  Observation seen;
  seen.T_robot_sensor = T_robot_lidar();
  seen.cloud = scanLidar(world, T_world_robot * seen.T_robot_sensor, m_config.lidar,
                         {m_config.seed, m_frame});
  if (m_keepOriginals)
    seen.original = synthetic_rawlog::labeledCloud(seen.cloud, seen.T_robot_sensor);
  return seen;
}

}  // namespace simulated_drive
