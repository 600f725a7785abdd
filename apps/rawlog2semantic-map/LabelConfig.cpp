#include "LabelConfig.h"

#include <strict_files/IniSection.h>

#include <stdexcept>

namespace rawlog2semantic_map {

using labeled_cloud::ScanStreamOptions;
using mrpt::config::CConfigFileBase;
using strict_files::IniSection;
using strict_files::OptionList;

namespace {

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

}  // namespace

void readLabelConfig(const CConfigFileBase& ini, Config& config) {
  readLabels(ini, config);
  readCameras(ini, config);
  config.cameras.skipProblems = config.stream.onProblem == ScanStreamOptions::OnProblem::Skip;
  config.insertion.conversion.occlusionParallax = config.cameras.occlusionParallax;
}

}  // namespace rawlog2semantic_map
