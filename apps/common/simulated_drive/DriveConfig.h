#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_driving/DriveOptions.h>
#include <semantic_navigation/Navigator.h>
#include <semantic_octree/FilterParameters.h>
#include <strict_files/OptionList.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Sensors.h>

#include <cstdint>
#include <filesystem>

namespace simulated_drive {

/** How the robot knows its pose. Without noise it knows it exactly. */
struct PoseOptions {
  /** Standard deviation of the way that odometry reports, meters after one meter; it grows with the
   * square root of the way. */
  double odometryNoise = 0;
  double turnNoise = 0;  ///< of the heading, degrees after one meter; grows alike

  void describe(strict_files::OptionList& list);
  bool isExact() const { return odometryNoise == 0 && turnNoise == 0; }
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Where wheels with noise say that the robot is. */
class SimulatedOdometry {
 public:
  /** \param seed of the noise */
  SimulatedOdometry(const mrpt::math::TPose2D& start, const PoseOptions& options,
                    std::uint64_t seed);

  /** \param motion true motion since the last call, in the robot's frame before it */
  void move(const mrpt::math::TPose2D& motion);
  const mrpt::math::TPose2D& pose() const { return m_pose; }

 private:
  PoseOptions m_options;
  mrpt::math::TPose2D m_pose;
  synthetic_world::Random m_noise;
};

/** The true motion of a car-like robot: commands are followed as fast as it can. */
class SimulatedRobot {
 public:
  SimulatedRobot(const mrpt::math::TPose2D& start, const semantic_driving::DriveOptions& limits);

  const semantic_driving::DriveState& state() const { return m_state; }
  /** \param seconds until the next command */
  void drive(const semantic_driving::DriveCommand& command, double seconds);

 private:
  void step(const semantic_driving::DriveCommand& command, double seconds);

  semantic_driving::DriveOptions m_limits;
  semantic_driving::DriveState m_state;
};

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
