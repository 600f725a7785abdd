#include "Config.h"

#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <strict_files/IniSection.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "poses/Poses.h"

namespace rawlog2semantic_map {

namespace fs = std::filesystem;
using labeled_cloud::Trajectory;
using strict_files::TextLine;

namespace {

/** What says where the robot is, or is a picture, is no scan. */
bool isScan(const mrpt::obs::CObservation& o) {
  return !IS_CLASS(o, mrpt::obs::CObservationRobotPose) &&
         !IS_CLASS(o, mrpt::obs::CObservationOdometry) &&
         !IS_CLASS(o, mrpt::obs::CObservationImage) && !IS_CLASS(o, mrpt::obs::CObservationIMU);
}

std::set<Trajectory::Time> timesOfScans(const std::vector<fs::path>& rawlogs) {
  std::set<Trajectory::Time> times;
  for (const fs::path& file : rawlogs) {
    labeled_cloud::RawlogReader reader(file);
    while (const auto entry = reader.next())
      for (const auto& observation : entry->observations)
        if (isScan(*observation)) times.insert(observation->timestamp);
  }
  return times;
}

bool hasMatrices(const std::vector<TextLine>& lines) {
  if (lines.empty()) return false;
  std::istringstream words(lines.front().text);
  int count = 0;
  for (std::string word; words >> word;) ++count;
  return count == 12;
}

/** KITTI's own poses are those of a camera, which looks along z. */
void checkForward(const std::vector<mrpt::poses::CPose3D>& poses, const fs::path& file) {
  mrpt::math::TPoint3D way;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const mrpt::poses::CPose3D step = poses[i] - poses[i - 1];
    way += mrpt::math::TPoint3D(step.x(), step.y(), step.z());
  }
  if (std::abs(way.z) > std::abs(way.x) + std::abs(way.y))
    throw std::runtime_error(
        file.string() +
        ": these are poses of a camera (they move along their z axes), expected those of the "
        "robot, with x forward; dataset2rawlog semantic-kitti converts KITTI's own");
}

}  // namespace

Trajectory restAtOrigin() {
  labeled_cloud::TrajectoryOptions always;
  always.tolerance = HUGE_VAL;
  Trajectory trajectory(always);
  trajectory.insert({}, {});
  return trajectory;
}

Trajectory loadTrajectory(const fs::path& file, const std::vector<fs::path>& rawlogs) {
  const std::vector<TextLine> lines = strict_files::readLines(file);
  if (!hasMatrices(lines)) return labeled_cloud::loadTumTrajectory(file);
  std::vector<mrpt::poses::CPose3D> read;
  for (const TextLine& line : lines)
    read.push_back(labeled_cloud::toMrpt(poses::poseOfMatrix(line)));
  checkForward(read, file);
  const std::set<Trajectory::Time> times = timesOfScans(rawlogs);
  if (read.size() != times.size())
    throw std::runtime_error(file.string() + ": " + std::to_string(read.size()) + " poses for " +
                             std::to_string(times.size()) + " scans");
  Trajectory trajectory;
  auto time = times.begin();
  for (const mrpt::poses::CPose3D& pose : read) trajectory.insert(*time++, pose);
  return trajectory;
}

using labeled_cloud::ScanStreamOptions;
using mrpt::config::CConfigFileMemory;
using strict_files::OptionList;
using strict_files::readOptions;
using strict_files::readSection;

namespace {

/** The sections that describe a camera: [camera NAME]. */
constexpr const char* kCameraSections = "camera *";

/** The label model is known by [labels]. */
void readInsertion(const CConfigFileMemory& ini, semantic_map::TInsertionOptions& insertion) {
  OptionList list = OptionList::of(insertion);
  for (const auto& name : OptionList::of(insertion.conversion.labels).names()) list.remove(name);
  readOptions(ini, "insertion", list);
  insertion.validate();
}

labeled_cloud::CameraCalibration readCamera(const CConfigFileMemory& ini, const std::string& name) {
  labeled_cloud::CameraDescription camera;
  const auto section = readOptions(ini, name, OptionList::of(camera));
  try {
    return camera.calibration();
  } catch (const std::invalid_argument& e) {
    section.fail(e.what());
  }
}

void readCameras(const CConfigFileMemory& ini, Config& config) {
  readSection(ini, "cameras", config.cameras);
  const std::string prefix = std::string(kCameraSections, std::string(kCameraSections).size() - 1);
  std::vector<std::string> names;
  ini.getAllSections(names);
  for (const std::string& name : names)
    if (name.rfind(prefix, 0) == 0)
      config.cameras.calibrations[name.substr(prefix.size())] = readCamera(ini, name);
  config.cameras.skipProblems = config.stream.onProblem == ScanStreamOptions::OnProblem::Skip;
}

}  // namespace

Config loadConfig(const fs::path& file) {
  Config config;
  strict_files::readIniFile<CConfigFileMemory>(file, [&](const CConfigFileMemory& ini) {
    strict_files::checkSections(ini, {"map", "insertion", "abstraction", "labels", "cameras",
                                      kCameraSections, "slam", "pictures"});
    readSection(ini, "map", config.map);
    readInsertion(ini, config.insertion);
    readSection(ini, "abstraction", config.abstraction);
    readOptions(ini, "labels",
                OptionList::of(config.labels, config.insertion.conversion.labels, config.stream));
    readCameras(ini, config);
    readSection(ini, "slam", config.slam);
    readOptions(ini, "pictures", OptionList::of(config.pictures, config.view));
  });
  if (!config.map.classes.empty())
    config.map.classes = (file.parent_path() / config.map.classes).lexically_normal();
  return config;
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
