#include "Config.h"

#include <mrpt/config/CConfigFile.h>
#include <strict_files/ErrorMessage.h>
#include <strict_files/IniSection.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "LabelConfig.h"

namespace rawlog2semantic_map {

namespace fs = std::filesystem;
using mrpt::config::CConfigFileBase;
using strict_files::IniSection;

namespace {

void refuseUnknownSections(const CConfigFileBase& ini) {
  static const std::set<std::string> kKnown = {"map",    "insertion", "abstraction", "trajectory",
                                               "labels", "cameras",   "pictures"};
  std::vector<std::string> sections, keys;
  ini.getAllSections(sections);
  for (const std::string& section : sections) {
    if (kKnown.count(section) || isCameraSection(section)) continue;
    ini.getAllKeys(section, keys);
    if (section.empty() && keys.empty()) continue;
    throw std::runtime_error("unknown section [" + section +
                             "]; known are [map], [insertion], [abstraction], [trajectory], "
                             "[labels], [cameras], [camera NAME], [pictures]");
  }
}

void readTrajectory(const CConfigFileBase& ini, Config& config) {
  IniSection section(ini, "trajectory");
  section.read("tolerance", config.trajectory.tolerance);
  section.read("maxGap", config.trajectory.maxGap);
  section.finish();
  config.trajectory.validate();
}

void readPictures(const CConfigFileBase& ini, Config& config) {
  IniSection section(ini, "pictures");
  section.read("width", config.pictures.width);
  section.read("height", config.pictures.height);
  section.read("title", config.pictures.title);
  double maxHeight = HUGE_VAL;
  section.read("maxHeight", maxHeight);
  if (maxHeight < HUGE_VAL) config.pictures.maxHeight = maxHeight;
  section.read("minOccupancy", config.pictures.minOccupancy);
  section.read("heading", config.view.heading);
  section.read("tilt", config.view.tilt);
  section.read("zoom", config.view.zoom);
  section.finish();
  config.pictures.validate();
  config.view.validate();
}

Config readConfig(const fs::path& file) {
  Config config;
  const mrpt::config::CConfigFile ini(file.string());
  refuseUnknownSections(ini);
  config.map.loadFromConfigFile(ini, "map");
  config.insertion.loadFromConfigFile(ini, "insertion");
  config.abstraction.loadFromConfigFile(ini, "abstraction");
  readTrajectory(ini, config);
  readLabelConfig(ini, config);
  readPictures(ini, config);
  if (!config.map.classes.empty())
    config.map.classes = (file.parent_path() / config.map.classes).lexically_normal();
  return config;
}

}  // namespace

Config loadConfig(const fs::path& file) {
  if (!fs::is_regular_file(file) || !std::ifstream(file))
    throw std::runtime_error(file.string() + ": cannot be read");
  try {
    return readConfig(file);
  } catch (const std::exception& e) {
    throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
  }
}

}  // namespace rawlog2semantic_map
