#include "DriveConfig.h"

#include <mrpt/config/CConfigFile.h>
#include <semantic_planning/vehicle/VehicleFile.h>
#include <strict_files/ErrorMessage.h>
#include <strict_files/IniSection.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace simulated_drive {

namespace fs = std::filesystem;
using mrpt::config::CConfigFileBase;
using strict_files::above;
using strict_files::atLeast;
using strict_files::between;
using strict_files::IniSection;
using strict_files::OptionList;

namespace {

// Options of other libraries, as long as those do not describe them themselves.

void describeMap(DriveConfig& config, OptionList& list) {
  list.add("resolution", config.voxelSize, "m", above(0), "edge of a voxel");
  list.add("accuracy", config.filter.accuracy, "", between(0, 1),
           "share of labels that name the true class");
  list.add("max_range", config.insertion.maxRange, "m", atLeast(0),
           "what lies beyond only carves free space; 0: no limit");
  list.add("carving_margin", config.insertion.carvingMargin, "m", atLeast(0),
           "before a return, that is not carved");
}

void describeNoise(synthetic_world::SensorNoise& noise, OptionList& list) {
  list.add("range_noise", noise.range, "m", atLeast(0), "standard deviation of ranges");
  list.add("label_noise", noise.label, "", between(0, 1), "share of labels that are wrong");
  list.add("dropout", noise.dropout, "", between(0, 1), "share of rays without a return");
}

void describeCamera(SensorConfig& sensors, OptionList& list) {
  synthetic_world::CameraOptions& camera = sensors.camera;
  list.add("width", camera.width, "pixels", atLeast(1), "of the image");
  list.add("height", camera.height, "pixels", atLeast(1), "of the image");
  list.add("fov", camera.horizontalFov, "degrees", above(0), "how wide it sees");
  list.add("min_range", camera.minRange, "m", atLeast(0), "nearer returns are lost");
  list.add("max_range", camera.maxRange, "m", above(0), "how far it sees");
  list.add("pitch", sensors.cameraPitch, "degrees", between(-90, 90), "how far down it looks");
  describeNoise(camera.noise, list);
}

void describeLidar(synthetic_world::LidarOptions& lidar, OptionList& list) {
  list.add("rings", lidar.rings, "", atLeast(1), "of beams");
  list.add("columns", lidar.columns, "", atLeast(1), "beams of a ring");
  list.add("lowest", lidar.lowest, "degrees", between(-90, 90), "elevation of the first ring");
  list.add("highest", lidar.highest, "degrees", between(-90, 90), "elevation of the last ring");
  list.add("min_range", lidar.minRange, "m", atLeast(0), "nearer returns are lost");
  list.add("max_range", lidar.maxRange, "m", above(0), "how far it sees");
  describeNoise(lidar.noise, list);
}

// Until here.

/** Beside DriveOptions in the same section. */
void describeLoop(DriveConfig& config, std::string& reactive, OptionList& list) {
  list.add("reactive", reactive, "", "file of MRPT's reactive navigator (.ini)");
  list.add("compressed_obstacles", config.compressedObstacles, "",
           "leaves of the compressed tree are obstacles");
  list.add("control_period", config.controlPeriod, "s", above(0), "between commands");
  list.add("time_limit", config.timeLimit, "s", above(0), "of simulated time");
  list.add("turn_acceleration", config.turnAcceleration, "rad/s^2", above(0),
           "of the simulated robot's steering");
}

/** Reads sections strictly, one after the other, and knows in the end which there are. */
class Sections {
 public:
  explicit Sections(const CConfigFileBase& ini) : m_ini(ini) {}

  IniSection readList(const std::string& name, const OptionList& list) {
    m_known.push_back(name);
    IniSection section(m_ini, name);
    section.read(list);
    section.finish();
    return section;
  }
  /** A struct that describes itself. */
  template <class Options>
  void read(const std::string& name, Options& options) {
    OptionList list;
    options.describe(list);
    readList(name, list);
    options.validate();
  }
  void refuseOthers() const {
    std::vector<std::string> sections, keys;
    m_ini.getAllSections(sections);
    for (const std::string& section : sections) {
      m_ini.getAllKeys(section, keys);
      if (section.empty() && keys.empty()) continue;
      if (std::find(m_known.begin(), m_known.end(), section) == m_known.end())
        throw std::runtime_error(strict_files::unknownWord("section", section, m_known));
    }
  }

 private:
  const CConfigFileBase& m_ini;
  std::vector<std::string> m_known;
};

void readMap(Sections& sections, DriveConfig& config) {
  OptionList list;
  describeMap(config, list);
  sections.readList("map", list);
  config.insertion.validate();
}

void readSensors(Sections& sections, SensorConfig& sensors) {
  OptionList general, camera, lidar;
  sensors.describe(general);
  describeCamera(sensors, camera);
  describeLidar(sensors.lidar, lidar);
  const IniSection section = sections.readList("sensors", general);
  if (!sensors.hasCamera && !sensors.hasLidar) section.fail("camera and lidar are both off");
  sections.readList("camera", camera);
  sections.readList("lidar", lidar);
  sensors.camera.validate();
  sensors.lidar.validate();
}

void readPlanner(Sections& sections, const fs::path& folder,
                 semantic_planning::PlannerOptions& planner) {
  std::string vehicle;
  OptionList list;
  list.add("vehicle", vehicle, "", "file of the vehicle (.yaml)");
  planner.describe(list);
  sections.readList("planner", list);
  if (!vehicle.empty()) planner.vehicle = semantic_planning::loadVehicle(folder / vehicle);
  planner.validate();
}

void readDrive(Sections& sections, const fs::path& folder, DriveConfig& config) {
  std::string reactive;
  OptionList list;
  config.drive.describe(list);
  describeLoop(config, reactive, list);
  const IniSection section = sections.readList("drive", list);
  config.drive.validate();
  if (reactive.empty()) section.fail("reactive: expected MRPT's .ini file");
  config.reactive = (folder / reactive).lexically_normal();
  if (config.drive.turningRadius > config.planner.vehicle.turningRadius)
    section.fail("turning_radius is larger than the planner's vehicle's");
}

}  // namespace

void SensorConfig::describe(OptionList& list) {
  list.add("period", period, "s", above(0), "between observations");
  list.add("camera", hasCamera, "", "the robot has a labeled camera");
  list.add("lidar", hasLidar, "", "the robot has a labeled LiDAR");
}

DriveConfig loadDriveConfig(const fs::path& file) {
  if (!fs::is_regular_file(file) || !std::ifstream(file))
    throw std::runtime_error(file.string() + ": cannot be read");
  try {
    DriveConfig config;
    config.planner.ground.keepOff = true;
    config.planner.shorten = true;
    mrpt::config::CConfigFile ini(file.string());
    ini.discardSavingChanges();
    Sections sections(ini);
    readMap(sections, config);
    readSensors(sections, config.sensors);
    sections.read("pose", config.pose);
    readPlanner(sections, file.parent_path(), config.planner);
    readDrive(sections, file.parent_path(), config);
    sections.read("guide", config.guide);
    sections.read("frontiers", config.guide.frontiers);
    sections.read("recovery", config.guide.recovery);
    sections.read("obstacles", config.obstacles);
    sections.refuseOthers();
    return config;
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
  }
}

}  // namespace simulated_drive
