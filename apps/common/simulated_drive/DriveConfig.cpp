#include "DriveConfig.h"

#include <mrpt/config/CConfigFile.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/ErrorMessage.h>
#include <strict_files/IniSection.h>

#include <fstream>
#include <set>
#include <stdexcept>

namespace simulated_drive {

namespace fs = std::filesystem;
using mrpt::config::CConfigFileBase;
using strict_files::IniSection;

namespace {

void refuseUnknownSections(const CConfigFileBase& ini) {
  static const std::set<std::string> kKnown = {"map",  "sensors", "camera", "lidar",
                                               "pose", "planner", "drive",  "guide"};
  std::vector<std::string> sections, keys;
  ini.getAllSections(sections);
  for (const std::string& section : sections) {
    ini.getAllKeys(section, keys);
    if (kKnown.count(section) || (section.empty() && keys.empty())) continue;
    throw std::runtime_error("unknown section [" + section +
                             "]; known are [map], [sensors], [camera], [lidar], [pose], "
                             "[planner], [drive], [guide]");
  }
}

void readYesNo(IniSection& section, const std::string& key, bool& value) {
  int number = value ? 1 : 0;
  section.read(key, number);
  if (number != 0 && number != 1) section.fail(key + " is neither 0 nor 1");
  value = number == 1;
}

void readMap(const CConfigFileBase& ini, DriveConfig& config) {
  IniSection section(ini, "map");
  section.read("resolution", config.voxelSize);
  section.read("accuracy", config.filter.accuracy);
  section.read("maxRange", config.insertion.maxRange);
  section.read("carvingMargin", config.insertion.carvingMargin);
  section.finish();
  config.insertion.validate();
  if (!(config.voxelSize > 0)) section.fail("resolution is not positive");
}

void readNoise(IniSection& section, synthetic_world::SensorNoise& noise) {
  section.read("rangeNoise", noise.range);
  section.read("labelNoise", noise.label);
  section.read("dropout", noise.dropout);
}

void readSensors(const CConfigFileBase& ini, SensorConfig& sensors) {
  IniSection section(ini, "sensors");
  section.read("period", sensors.period);
  readYesNo(section, "camera", sensors.hasCamera);
  readYesNo(section, "lidar", sensors.hasLidar);
  section.finish();
  if (!(sensors.period > 0)) section.fail("period is not positive");
  if (!sensors.hasCamera && !sensors.hasLidar) section.fail("camera and lidar are both 0");
}

void readCamera(const CConfigFileBase& ini, SensorConfig& sensors) {
  IniSection section(ini, "camera");
  section.read("width", sensors.camera.width);
  section.read("height", sensors.camera.height);
  section.read("fov", sensors.camera.horizontalFov);
  section.read("maxRange", sensors.camera.maxRange);
  section.read("pitch", sensors.cameraPitch);
  readNoise(section, sensors.camera.noise);
  section.finish();
  sensors.camera.validate();
}

void readLidar(const CConfigFileBase& ini, SensorConfig& sensors) {
  IniSection section(ini, "lidar");
  section.read("rings", sensors.lidar.rings);
  section.read("columns", sensors.lidar.columns);
  section.read("lowest", sensors.lidar.lowest);
  section.read("highest", sensors.lidar.highest);
  section.read("maxRange", sensors.lidar.maxRange);
  readNoise(section, sensors.lidar.noise);
  section.finish();
  sensors.lidar.validate();
}

void readPose(const CConfigFileBase& ini, PoseOptions& pose) {
  IniSection section(ini, "pose");
  section.read("odometryNoise", pose.odometryNoise);
  section.read("turnNoise", pose.turnNoise);
  readYesNo(section, "correct", pose.correct);
  section.read("particles", pose.particles);
  section.read("points", pose.points);
  section.read("pointWeight", pose.pointWeight);
  section.finish();
  pose.validate();
}

void readPlanner(const CConfigFileBase& ini, const fs::path& folder,
                 semantic_planning::PlannerOptions& planner) {
  IniSection section(ini, "planner");
  std::string vehicle;
  section.read("vehicle", vehicle);
  if (!vehicle.empty()) planner.vehicle = semantic_planning::loadVehicle(folder / vehicle);
  int vertices = static_cast<int>(planner.roadmap.vertices);
  section.read("vertices", vertices);
  if (vertices < 0) section.fail("vertices is negative");
  planner.roadmap.vertices = static_cast<std::size_t>(vertices);
  section.read("neighbors", planner.roadmap.neighbors);
  section.read("headings", planner.roadmap.headings);
  section.read("spacing", planner.roadmap.spacing);
  section.read("buffer", planner.roadmap.regionBuffer);
  section.read("longestEdge", planner.roadmap.connectionRadius);
  section.read("bridgeGap", planner.ground.bridgeGap);
  section.read("unknownGap", planner.ground.unknownGap);
  readYesNo(section, "keepOff", planner.ground.keepFootprintOffForbidden);
  planner.shorten = true;
  readYesNo(section, "shorten", planner.shorten);
  section.finish();
  planner.validate();
}

void readDrive(const CConfigFileBase& ini, const fs::path& folder, DriveConfig& config) {
  IniSection section(ini, "drive");
  semantic_driving::DriveOptions& drive = config.drive;
  section.read("maxSpeed", drive.maxSpeed);
  section.read("maxAcceleration", drive.maxAcceleration);
  section.read("maxSideAcceleration", drive.maxSideAcceleration);
  section.read("turningRadius", drive.turningRadius);
  section.read("margin", drive.margin);
  section.read("lookAhead", drive.lookAhead);
  section.read("exactEnd", drive.exactEnd);
  section.read("maxSensorAge", drive.maxSensorAge);
  readYesNo(section, "alwaysReactive", drive.alwaysReactive);
  readYesNo(section, "compressedObstacles", config.compressedObstacles);
  std::string reactive;
  section.read("reactive", reactive);
  section.read("timeLimit", config.timeLimit);
  section.finish();
  drive.validate();
  if (reactive.empty()) section.fail("reactive: expected MRPT's .ini file");
  config.reactive = (folder / reactive).lexically_normal();
  if (drive.turningRadius > config.planner.vehicle.turningRadius)
    section.fail("turningRadius is larger than the planner's vehicle's");
}

void readGuide(const CConfigFileBase& ini, semantic_driving::GuideOptions& guide) {
  IniSection section(ini, "guide");
  section.read("period", guide.period);
  section.read("patience", guide.patience);
  section.read("giveUpAfter", guide.giveUpAfter);
  section.finish();
  guide.validate();
}

}  // namespace

DriveConfig loadDriveConfig(const fs::path& file) {
  if (!fs::is_regular_file(file) || !std::ifstream(file))
    throw std::runtime_error(file.string() + ": cannot be read");
  try {
    DriveConfig config;
    config.planner.ground.keepFootprintOffForbidden = true;
    mrpt::config::CConfigFile ini(file.string());
    ini.discardSavingChanges();
    refuseUnknownSections(ini);
    readMap(ini, config);
    readSensors(ini, config.sensors);
    readCamera(ini, config.sensors);
    readLidar(ini, config.sensors);
    readPose(ini, config.pose);
    readPlanner(ini, file.parent_path(), config.planner);
    readDrive(ini, file.parent_path(), config);
    readGuide(ini, config.guide);
    return config;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
  }
}

}  // namespace simulated_drive
