#include "DriveConfig.h"

#include <mrpt/config/CConfigFile.h>
#include <semantic_planning/vehicle/VehicleOptions.h>
#include <strict_files/IniSection.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>
#include <synthetic_world/Solids.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace simulated_drive {

namespace fs = std::filesystem;
using mrpt::config::CConfigFileBase;
using strict_files::above;
using strict_files::between;
using strict_files::IniSection;
using strict_files::OptionList;

namespace {

/** Beside DriveOptions in the same section. */
void describeLoop(DriveConfig& config, std::string& reactive, OptionList& list) {
  list.add("reactive", reactive, "", "file of MRPT's reactive navigator (.ini)");
  list.add("control_period", config.controlPeriod, "s", above(0), "between commands");
  list.add(
      "mapping_latency", config.mappingLatency, "s", strict_files::atLeast(0),
      "from a scan until the map has it, in a thread of its own; till then the robot drives by "
      "what it knew");
  list.add("time_limit", config.timeLimit, "s", above(0), "of simulated time");
}

/** Reads sections strictly, one after the other, and knows in the end which there are. */
class Sections {
 public:
  explicit Sections(const CConfigFileBase& ini) : m_ini(ini) {}

  IniSection read(const std::string& name, const OptionList& list) {
    m_known.push_back(name);
    IniSection section(m_ini, name);
    section.read(list);
    section.finish();
    return section;
  }
  /** A struct that describes and checks itself. */
  template <class Options>
  void readAll(const std::string& name, Options& options) {
    m_known.push_back(name);
    strict_files::readSection(m_ini, name, options);
  }
  void refuseOthers() const { strict_files::checkSections(m_ini, m_known); }

 private:
  const CConfigFileBase& m_ini;
  std::vector<std::string> m_known;
};

void readMap(Sections& sections, const fs::path& folder, DriveConfig& config) {
  OptionList map, insertion;
  map.add("resolution", config.voxelSize, "m", above(0), "edge of a voxel");
  std::string halfLives;
  map.add("half_lives", halfLives, "",
          "class table (YAML) with half-lives, by which the map forgets");
  sections.read("map", map);
  if (!halfLives.empty()) config.halfLives = (folder / halfLives).lexically_normal();
  config.insertion.describe(insertion);
  config.filter.describe(insertion);
  sections.read("insertion", insertion);
  config.insertion.validate();
}

void readSensors(Sections& sections, SensorConfig& sensors) {
  OptionList general, camera;
  sensors.describe(general);
  const IniSection section = sections.read("sensors", general);
  if (!sensors.hasCamera && !sensors.hasLidar) section.fail("camera and lidar are both off");
  sensors.lidar.noise = sensors.camera.noise;
  sensors.camera.describe(camera);
  camera.add("pitch", sensors.cameraPitch, "degrees", between(-90, 90), "how far down it looks");
  sections.read("camera", camera);
  sensors.camera.validate();
  sections.readAll("lidar", sensors.lidar);
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

void readPlanner(Sections& sections, const fs::path& folder,
                 semantic_planning::PlannerOptions& planner) {
  std::string vehicle;
  OptionList list;
  list.add("vehicle", vehicle, "", "file of the vehicle (.yaml)");
  planner.describe(list);
  sections.read("planner", list);
  if (!vehicle.empty()) planner.vehicle = semantic_planning::loadVehicle(folder / vehicle);
  planner.validate();
}

void readDrive(Sections& sections, const fs::path& folder, DriveConfig& config) {
  std::string reactive;
  OptionList list;
  config.drive.describe(list);
  describeLoop(config, reactive, list);
  const IniSection section = sections.read("drive", list);
  config.drive.validate();
  if (reactive.empty()) section.fail("reactive: expected MRPT's .ini file");
  config.reactive = (folder / reactive).lexically_normal();
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
  if (!fs::is_regular_file(file) || !std::ifstream(file))
    throw std::runtime_error(file.string() + ": cannot be read");
  try {
    DriveConfig config;
    strict_files::checkIniText(strict_files::readText(file));
    mrpt::config::CConfigFile ini(file.string());
    ini.discardSavingChanges();
    Sections sections(ini);
    readMap(sections, file.parent_path(), config);
    readSensors(sections, config.sensors);
    sections.readAll("pose", config.pose);
    sections.readAll("slam", config.slam);
    readPlanner(sections, file.parent_path(), config.planner);
    readDrive(sections, file.parent_path(), config);
    sections.readAll("guide", config.guide);
    sections.readAll("movers", config.movers);
    sections.readAll("focus", config.focus);
    sections.readAll("explore", config.explore);
    setSensor(config);
    const semantic_driving::MoverTracker known(config.movers, synthetic_world::classTable());
    sections.refuseOthers();
    return config;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
  }
}

}  // namespace simulated_drive
