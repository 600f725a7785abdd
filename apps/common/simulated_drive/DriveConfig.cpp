#include "DriveConfig.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/math/wrap2pi.h>
#include <strict_files/IniSection.h>
#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>

namespace simulated_drive {

using mrpt::math::TPose2D;

void PoseOptions::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("odometry_noise", odometryNoise, "m", between(0, 1),
           "standard deviation of the way after a meter; grows with its square root");
  list.add("turn_noise", turnNoise, "degrees", between(0, 90),
           "standard deviation of the heading after a meter; grows alike");
}

void PoseOptions::validate() const { strict_files::checkOptions(*this, "PoseOptions"); }

SimulatedOdometry::SimulatedOdometry(const TPose2D& start, const PoseOptions& options,
                                     std::uint64_t seed)
    : m_options(options), m_pose(start), m_noise(synthetic_world::Random::ofStream(seed, 1, 0)) {
  m_options.validate();
}

void SimulatedOdometry::move(const TPose2D& motion) {
  constexpr double kDegree = M_PI / 180;
  const double root = std::sqrt(std::hypot(motion.x, motion.y));
  TPose2D measured = motion;
  measured.x += m_options.odometryNoise * root * m_noise.normal();
  measured.phi += m_options.turnNoise * kDegree * root * m_noise.normal();
  m_pose = m_pose + measured;
}

using semantic_driving::DriveCommand;

namespace {

/** From one value towards another, by at most this much. */
double towards(double from, double to, double most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

SimulatedRobot::SimulatedRobot(const mrpt::math::TPose2D& start,
                               const semantic_driving::DriveOptions& limits)
    : m_limits(limits) {
  m_state.pose = start;
}

void SimulatedRobot::drive(const DriveCommand& command, double seconds) {
  constexpr int kSteps = 10;
  for (int i = 0; i < kSteps; ++i) step(command, seconds / kSteps);
}

void SimulatedRobot::step(const DriveCommand& command, double seconds) {
  constexpr double kTurnAcceleration = 4;  // rad/s^2, of the steering
  const double wanted = std::clamp(command.speed, -m_limits.maxSpeed, m_limits.maxSpeed);
  m_state.speed = towards(m_state.speed, wanted, m_limits.maxAcceleration * seconds);
  // The command's curve, not its turning: a car that is not up to its speed steers as if it were.
  const double curvature = std::abs(command.speed) > 1e-6 ? command.turn / command.speed : 0;
  const double most = std::abs(m_state.speed) / m_limits.turningRadius;
  const double turn = std::clamp(curvature * m_state.speed, -most, most);
  m_state.turn = std::clamp(towards(m_state.turn, turn, kTurnAcceleration * seconds), -most, most);
  const double heading = m_state.pose.phi + m_state.turn * seconds / 2;
  m_state.pose.x += m_state.speed * seconds * std::cos(heading);
  m_state.pose.y += m_state.speed * seconds * std::sin(heading);
  m_state.pose.phi = mrpt::math::wrapToPi(m_state.pose.phi + m_state.turn * seconds);
}

namespace fs = std::filesystem;
using mrpt::config::CConfigFileMemory;
using strict_files::above;
using strict_files::between;
using strict_files::IniSection;
using strict_files::OptionList;
using strict_files::readOptions;
using strict_files::readSection;

namespace {

void readMap(const CConfigFileMemory& ini, const fs::path& folder, DriveConfig& config) {
  OptionList map;
  map.add("resolution", config.voxelSize, "m", above(0), "edge of a voxel");
  std::string halfLives;
  map.add("half_lives", halfLives, "",
          "class table (YAML) with half-lives, by which the map forgets");
  readOptions(ini, "map", map);
  if (!halfLives.empty()) config.halfLives = (folder / halfLives).lexically_normal();
  readOptions(ini, "insertion", OptionList::of(config.insertion, config.filter));
  config.insertion.validate();
}

void readSensors(const CConfigFileMemory& ini, SensorConfig& sensors) {
  const IniSection section = readOptions(ini, "sensors", OptionList::of(sensors));
  if (!sensors.hasCamera && !sensors.hasLidar) section.fail("camera and lidar are both off");
  sensors.lidar.noise = sensors.camera.noise;
  OptionList camera = OptionList::of(sensors.camera);
  camera.add("pitch", sensors.cameraPitch, "degrees", between(-90, 90), "how far down it looks");
  readOptions(ini, "camera", camera);
  sensors.camera.validate();
  readSection(ini, "lidar", sensors.lidar);
}

/** Exploring knows the sensors: the LiDAR, if there is one, for it sees all around. */
void setSensor(DriveConfig& config) {
  constexpr double kLidarHeight = 1.4, kCameraHeight = 1.2;  // m
  const SensorConfig& sensors = config.sensors;
  semantic_driving::ExploreOptions& explore = config.explore;
  explore.sensorHeight = sensors.hasLidar ? kLidarHeight : kCameraHeight;
  if (sensors.hasLidar) {
    const auto& lidar = sensors.lidar;
    explore.sensor = {lidar.maxRange, lidar.lowest, lidar.highest, 360, lidar.rings, lidar.columns};
  } else {
    const auto& camera = sensors.camera;
    const double half = std::atan(camera.cy() / camera.focalLength()) * 180 / M_PI;
    explore.sensor = {camera.maxRange, -sensors.cameraPitch - half, half - sensors.cameraPitch,
                      camera.horizontalFov};
  }
  if (config.insertion.maxRange > 0)
    explore.sensor.range = std::min(explore.sensor.range, config.insertion.maxRange);
}

void readNavigation(const CConfigFileMemory& ini, const fs::path& folder, DriveConfig& config) {
  OptionList drive;
  drive.add("control_period", config.controlPeriod, "s", above(0), "between commands");
  drive.add("time_limit", config.timeLimit, "s", above(0), "of simulated time");
  readSections(ini, folder, drive, config);
  if (config.reactive.empty()) IniSection(ini, "drive").fail("reactive: expected MRPT's .ini file");
}

}  // namespace

void SensorConfig::describe(OptionList& list) {
  list.add("period", period, "s", above(0), "between observations");
  list.add("camera", hasCamera, "", "the robot has a labeled camera");
  list.add("lidar", hasLidar, "", "the robot has a labeled LiDAR");
  list.add(
      "empty_carves", emptyCarves, "",
      "a pixel or beam without a return says that nothing is within range; not for sensors that "
      "lose returns");
  camera.noise.describe(list);
}

semantic_slam::MapperOptions DriveConfig::mapping() const {
  semantic_slam::MapperOptions mapping;
  mapping.insertion = insertion;
  mapping.localize = !pose.isExact();
  mapping.slam = slam;
  mapping.slam.level = true;
  mapping.insertEvery = 3;  // it may wait for somebody to go away
  mapping.scans = fs::temp_directory_path();
  return mapping;
}

DriveConfig loadDriveConfig(const fs::path& file) {
  DriveConfig config;
  const fs::path folder = file.parent_path();
  strict_files::readIniFile<CConfigFileMemory>(file, [&](const CConfigFileMemory& ini) {
    readMap(ini, folder, config);
    readSensors(ini, config.sensors);
    readSection(ini, "pose", config.pose);
    readSection(ini, "slam", config.slam);
    readNavigation(ini, folder, config);
    setSensor(config);
    const semantic_driving::DynamicObstacleTracker known(config.movers,
                                                         synthetic_world::classTable());
    strict_files::checkSections(
        ini, {"map", "insertion", "sensors", "camera", "lidar", "pose", "slam", "planner", "drive",
              "guide", "movers", "focus", "explore"});
  });
  return config;
}

}  // namespace simulated_drive
