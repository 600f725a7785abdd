#pragma once
#include <semantic_navigation/Navigator.h>
#include <semantic_octree/FilterParameters.h>
#include <synthetic_world/Sensors.h>

#include <filesystem>

#include "SimulatedRobot.h"

namespace simulated_drive {

/** What the robot sees with. */
struct SensorConfig {
  bool hasCamera = true, hasLidar = true;
  synthetic_world::CameraOptions camera;
  double cameraPitch = 15;  ///< degrees down
  synthetic_world::LidarOptions lidar;
  double period = 0.5;  ///< s
  /** A pixel or beam without a return says that nothing is within the sensor's range. */
  bool emptyCarves = false;
  std::uint64_t seed = 1;  ///< of the odometry's noise, too

  /** What is not the camera's or the LiDAR's alone: the LiDAR has the camera's noise. */
  void describe(strict_files::OptionList& list);
};

/** Everything that the .ini file says. */
struct DriveConfig : semantic_navigation::NavigatorOptions {
  double voxelSize = 0.2;  ///< m
  std::filesystem::path
      halfLives;  ///< class table whose half-lives the map has; empty: it keeps its own
  semantic_octree::FilterParameters filter;
  semantic_octree::InsertionOptions insertion;
  SensorConfig sensors;
  PoseOptions pose;
  semantic_slam::SlamOptions slam;  ///< with noise
  double controlPeriod = 0.1;       ///< s
  double timeLimit = 600;           ///< s of simulated time

  /** What is known of odometry, it is told: its noise, and that height and tilt are right. */
  semantic_slam::MapperOptions mapping() const;
};

/** Reads a configuration; what is absent has its default. Files that it names are relative to it.
 * \throw std::runtime_error naming file, section, key and value. */
DriveConfig loadDriveConfig(const std::filesystem::path& file);

}  // namespace simulated_drive
