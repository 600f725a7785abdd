#include "Config.h"

#include <mrpt/config/CConfigFile.h>
#include <strict_files/IniSection.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <fstream>
#include <stdexcept>

namespace rawlog2semantic_map {

namespace fs = std::filesystem;
using labeled_cloud::ScanStreamOptions;
using mrpt::config::CConfigFileBase;
using strict_files::IniSection;
using strict_files::OptionList;
using strict_files::readSection;

namespace {

/** The sections that describe a camera: [camera NAME]. */
constexpr const char* kCameraSections = "camera *";

/** The label model is known by [labels]. */
void readInsertion(const CConfigFileBase& ini, semantic_map::TInsertionOptions& insertion) {
  OptionList list, labels;
  insertion.describe(list);
  insertion.conversion.labels.describe(labels);
  for (const std::string& name : labels.names()) list.remove(name);
  IniSection section(ini, "insertion");
  section.read(list);
  section.finish();
  insertion.validate();
}

void readPictures(const CConfigFileBase& ini, Config& config) {
  OptionList list;
  config.pictures.describe(list);
  config.view.describe(list);
  IniSection section(ini, "pictures");
  section.read(list);
  section.finish();
}

void readLabels(const CConfigFileBase& ini, Config& config) {
  OptionList list;
  config.labels.describe(list);
  config.insertion.conversion.labels.describe(list);
  config.stream.describe(list);
  IniSection section(ini, "labels");
  section.read(list);
  section.finish();
}

labeled_cloud::CameraCalibration readCamera(const CConfigFileBase& ini, const std::string& name) {
  labeled_cloud::CameraDescription camera;
  OptionList list;
  camera.describe(list);
  IniSection section(ini, name);
  section.read(list);
  section.finish();
  try {
    return camera.calibration();
  } catch (const std::invalid_argument& e) {
    section.fail(e.what());
  }
}

void readCameras(const CConfigFileBase& ini, Config& config) {
  strict_files::readSection(ini, "cameras", config.cameras);
  const std::string prefix = std::string(kCameraSections, std::string(kCameraSections).size() - 1);
  std::vector<std::string> names;
  ini.getAllSections(names);
  for (const std::string& name : names)
    if (name.rfind(prefix, 0) == 0)
      config.cameras.calibrations[name.substr(prefix.size())] = readCamera(ini, name);
}

void readLabelConfig(const CConfigFileBase& ini, Config& config) {
  readLabels(ini, config);
  readCameras(ini, config);
  config.cameras.skipProblems = config.stream.onProblem == ScanStreamOptions::OnProblem::Skip;
}

Config readConfig(const fs::path& file) {
  Config config;
  strict_files::checkIniText(strict_files::readText(file));
  const mrpt::config::CConfigFile ini(file.string());
  strict_files::checkSections(ini, {"map", "insertion", "abstraction", "labels", "cameras",
                                    kCameraSections, "slam", "pictures"});
  readSection(ini, "map", config.map);
  readInsertion(ini, config.insertion);
  readSection(ini, "abstraction", config.abstraction);
  readLabelConfig(ini, config);
  readSection(ini, "slam", config.slam);
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
