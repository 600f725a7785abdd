#include "Config.h"

#include <labeled_cloud/NetworkLabeler.h>
#include <mrpt/config/CConfigFile.h>
#include <strict_files/IniSection.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <fstream>
#include <map>
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

using labeled_cloud::ImageLabeler;
using labeled_cloud::LabelFolder;
using labeled_cloud::LabelImage;
using labeled_cloud::NetworkLabeler;
using semantic_types::ClassTable;

namespace {

/** A folder for each camera, or one for all that have none of their own. */
class FolderOfSensor : public ImageLabeler {
 public:
  void add(const std::string& source, const ClassTable& table, const Config& config) {
    const bool forAll = std::filesystem::exists(source) || source.find('=') == std::string::npos;
    const std::size_t split = forAll ? 0 : source.find('=');
    const std::string folder = source.substr(forAll ? 0 : split + 1);
    if (!m_folders.emplace(source.substr(0, split), LabelFolder(folder, table, config.labels))
             .second)
      throw std::runtime_error("--labels " + source + ": a second folder for the same sensor");
  }

  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override {
    auto folder = m_folders.find(observation.sensorLabel);
    if (folder == m_folders.end()) folder = m_folders.find("");
    if (folder == m_folders.end()) return std::nullopt;
    return folder->second.label(observation);
  }

 private:
  /** By the sensor's label, "" for all others. */
  std::map<std::string, LabelFolder> m_folders;
};

}  // namespace

std::shared_ptr<ImageLabeler> makeLabeler(const LabelSources& sources, const ClassTable& table,
                                          const Config& config) {
  if (sources.network.empty() != sources.networkConfig.empty())
    throw std::runtime_error("--network and --network-config belong together");
  if (!sources.network.empty() && !sources.folders.empty())
    throw std::runtime_error("labels come from --labels or from --network, not from both");
  if (!sources.network.empty())
    return std::make_shared<NetworkLabeler>(
        sources.network, table.size(),
        labeled_cloud::loadNetworkOptions(sources.networkConfig, table));
  if (sources.folders.empty()) return nullptr;
  auto folders = std::make_shared<FolderOfSensor>();
  for (const std::string& source : sources.folders) folders->add(source, table, config);
  return folders;
}

}  // namespace rawlog2semantic_map
