#pragma once
#include <gtest/gtest.h>
#include <semantic_slam/Registration.h>
#include <semantic_slam/Slam.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

/** What sensors see on a round, and what odometry says of it. */
namespace recordings {

using namespace semantic_slam;
using synthetic_world::FrameSeed;

struct Recording {
  std::vector<LabeledCloud> clouds;
  std::vector<Eigen::Isometry3d> truth, odometry;
};

inline const Eigen::Isometry3d kRobotLidar(Eigen::Translation3d(0, 0, 1.8));
/** Looks a little down. */
inline const Eigen::Isometry3d kRobotCamera = Eigen::Translation3d(0.25, 0, 1.4) *
                                              Eigen::AngleAxisd(0.14, Eigen::Vector3d::UnitY()) *
                                              Eigen::Isometry3d::Identity();

/** What is seen of a world by a robot that is there. */
using Sensor = std::function<LabeledCloud(const synthetic_world::World&,
                                          const Eigen::Isometry3d& T_world_robot, FrameSeed)>;

inline Sensor lidarOf(double labelNoise) {
  synthetic_world::LidarOptions lidar;
  lidar.rings = 32;
  lidar.columns = 360;
  lidar.maxRange = 50;
  lidar.noise.range = 0.02;
  lidar.noise.label = labelNoise;
  return [lidar](const auto& world, const auto& T_world_robot, FrameSeed seed) {
    return scanLidar(world, T_world_robot * kRobotLidar, lidar, seed);
  };
}

inline const Eigen::Isometry3d kRobotLaser(Eigen::Translation3d(0.2, 0, 0.6));

/** A laser scanner in the plane, at knee height, two beams a degree. It knows no classes. */
inline Sensor laserOf() {
  synthetic_world::LidarOptions laser;
  laser.rings = 1;
  laser.columns = 720;
  laser.lowest = laser.highest = 0;
  laser.maxRange = 30;
  laser.noise.range = 0.02;
  return [laser](const auto& world, const auto& T_world_robot, FrameSeed seed) {
    LabeledCloud cloud = scanLidar(world, T_world_robot * kRobotLaser, laser, seed);
    cloud.classes.clear();
    return cloud;
  };
}

/** A single RGB-D camera, 160 x 120 pixels. \param maxRange meters */
inline Sensor cameraOf(double maxRange) {
  synthetic_world::CameraOptions camera;
  camera.width = 160;
  camera.height = 120;
  camera.horizontalFov = 90;
  camera.maxRange = maxRange;
  camera.color = false;
  camera.noise.range = 0.02;
  camera.noise.label = 0.1;
  return [camera](const auto& world, const auto& T_world_robot, FrameSeed seed) {
    const auto frame = renderCamera(world, T_world_robot * kRobotCamera, camera, seed);
    LabeledCloud cloud;
    for (int row = 0; row < camera.height; ++row)
      for (int column = 0; column < camera.width; ++column) {
        const double depth = frame.depth.at(row, column);
        if (depth == 0) continue;
        cloud.points.push_back((camera.ray(row, column) * depth).cast<float>());
        cloud.classes.push_back(frame.labels.at(row, column));
      }
    return cloud;
  };
}

/** Once around a scene and some meters more; odometry that is 1 % too long, and turns 0.1
 * degrees a meter too far, with as much noise beside.
 * \param hills of the scene; where it is flat, odometry does not tilt */
inline Recording recordingOf(const std::string& scene, std::uint64_t seed, const Sensor& sensor,
                             double meters = 1e9, double hills = 1) {
  const synthetic_world::Scene place = synthetic_world::makeScene(scene, seed, hills);
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto uniform = [&random] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  Recording r;
  for (double s = 0; s < std::min(meters, place.route.length() + 15); s += 1) {
    const Eigen::Isometry3d T = place.T_world_robot(s);
    r.clouds.push_back(sensor(place.world, T, {seed, r.truth.size()}));
    if (r.truth.empty()) {
      r.odometry.push_back(T);
    } else {
      Vector6 motion = vectorOf(r.truth.back().inverse() * T);
      const double way = motion.head<3>().norm(), angle = 0.1 * M_PI / 180 * way;
      motion.head<3>() *= 1.01 + 0.01 * uniform();
      motion[5] += angle * (1 + uniform());
      for (int axis : {3, 4}) motion[axis] += 0.2 * hills * angle * uniform();
      r.odometry.push_back(r.odometry.back() * poseOf(motion));
    }
    r.truth.push_back(T);
  }
  return r;
}

/** Who saw a scene for a map of it, until when. */
struct Mapping {
  Sensor sensor;
  Eigen::Isometry3d T_robot_sensor;
  double meters, voxelSize = 0.2;
  double hills = 1;  ///< of the scene
  double step = 3;   ///< m, between scans
};

/** What somebody else saw of a scene, other scans from between the poses of recordingOf(). */
inline semantic_octree::SemanticOcTree mapOf(const std::string& scene, std::uint64_t seed,
                                             const Mapping& by) {
  const synthetic_world::Scene place = synthetic_world::makeScene(scene, seed, by.hills);
  semantic_octree::SemanticOcTree map(by.voxelSize, synthetic_world::classTable());
  semantic_octree::InsertionOptions options;
  options.maxRange = 30;
  for (double s = 0.5; s < by.meters; s += by.step) {
    const Eigen::Isometry3d T = place.T_world_robot(s);
    const auto frame = static_cast<std::uint64_t>(1000 + s);
    map.insert(by.sensor(place.world, T, {seed, frame}), T * by.T_robot_sensor, options);
  }
  return map;
}

/** Odometry that begins elsewhere. \param off from where it began, in the robot's frame */
inline void moveOdometry(Recording& r, const Vector6& off) {
  const Eigen::Isometry3d T = r.truth[0] * poseOf(off) * r.truth[0].inverse();
  for (Eigen::Isometry3d& pose : r.odometry) pose = T * pose;
}

inline void addAll(Slam& slam, const Recording& r, const Eigen::Isometry3d& T_robot_sensor) {
  for (std::size_t i = 0; i < r.clouds.size(); ++i)
    slam.add(r.clouds[i], T_robot_sensor, r.odometry[i]);
  ASSERT_EQ(slam.poses().size(), r.truth.size()) << "each scan is a keyframe";
}

struct PathErrors {
  double rootMeanSquare = 0, first = 0, largest = 0, last = 0;  // m
  double degrees = 0;                                           // largest
};

inline PathErrors errorsOf(const std::vector<Eigen::Isometry3d>& poses, const Recording& r) {
  PathErrors e;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Vector6 off = vectorOf(r.truth[k].inverse() * poses[k]);
    e.last = off.head<3>().norm();
    if (k == 0) e.first = e.last;
    e.rootMeanSquare += e.last * e.last / static_cast<double>(poses.size());
    e.largest = std::max(e.largest, e.last);
    e.degrees = std::max(e.degrees, off.tail<3>().norm() * 180 / M_PI);
  }
  e.rootMeanSquare = std::sqrt(e.rootMeanSquare);
  return e;
}

}  // namespace recordings
