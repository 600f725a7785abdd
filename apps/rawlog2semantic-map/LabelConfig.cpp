#include "LabelConfig.h"

#include <strict_files/IniSection.h>

#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

namespace rawlog2semantic_map {

using labeled_cloud::CameraCalibration;
using labeled_cloud::LabelImage;
using labeled_cloud::LabelModel;
using labeled_cloud::ScanStreamOptions;
using mrpt::config::CConfigFileBase;
using strict_files::IniSection;

namespace {

const std::string kCameraPrefix = "camera ";

/** Reads one of some words. */
template <typename T>
void readChoice(IniSection& section, const std::string& key,
                const std::map<std::string, T>& choices, T& value) {
  std::string text;
  section.read(key, text);
  if (text.empty()) return;
  if (const auto found = choices.find(text); found != choices.end()) {
    value = found->second;
    return;
  }
  std::string expected;
  for (const auto& [name, choice] : choices) expected += (expected.empty() ? "" : " or ") + name;
  section.fail(key + " is '" + text + "', expected " + expected);
}

void readLabels(const CConfigFileBase& ini, Config& config) {
  using Match = labeled_cloud::LabelFolderOptions::Match;
  using OnProblem = ScanStreamOptions::OnProblem;
  IniSection section(ini, "labels");
  readChoice<Match>(section, "match", {{"Time", Match::Time}, {"Name", Match::Name}},
                    config.labels.match);
  section.read("tolerance", config.labels.tolerance);
  readChoice<LabelImage::View>(
      section, "image", {{"Depth", LabelImage::View::Depth}, {"Color", LabelImage::View::Color}},
      config.labels.view);
  readChoice<LabelModel::Kind>(section, "kind",
                               {{"Soft", LabelModel::Kind::Soft}, {"Hard", LabelModel::Kind::Hard}},
                               config.labelModel.kind);
  section.read("minConfidence", config.labelModel.minConfidence);
  readChoice<bool>(section, "unlabeled", {{"Occupancy", true}, {"Skip", false}},
                   config.stream.withoutLabels);
  readChoice<OnProblem>(section, "onProblem",
                        {{"Stop", OnProblem::Stop}, {"Skip", OnProblem::Skip}},
                        config.stream.onProblem);
  section.finish();
  config.labels.validate();
  config.labelModel.validate();
}

/** Values of which all or none are given. */
template <std::size_t N>
std::optional<std::array<double, N>> readAllOf(IniSection& section,
                                               const std::array<const char*, N>& keys) {
  std::array<double, N> values;
  values.fill(NAN);
  std::size_t given = 0;
  for (std::size_t i = 0; i < N; ++i) {
    section.read(keys[i], values[i]);
    given += !std::isnan(values[i]);
  }
  if (given == 0) return std::nullopt;
  for (std::size_t i = 0; i < N; ++i)
    if (std::isnan(values[i])) section.fail(std::string(keys[i]) + " is missing");
  return values;
}

void readDistortion(IniSection& section, mrpt::img::TCamera& camera) {
  std::string model = "plumb_bob", text;
  section.read("distortion", model);
  section.read("dist", text);
  if (model != "plumb_bob" && model != "kannala_brandt")
    section.fail("distortion is '" + model + "', expected plumb_bob or kannala_brandt");
  camera.distortion = model == "plumb_bob" ? mrpt::img::DistortionModel::plumb_bob
                                           : mrpt::img::DistortionModel::kannala_brandt;
  std::istringstream stream(text);
  std::size_t count = 0;
  for (double k; stream >> k && count < camera.dist.size();) camera.dist[count++] = k;
  if (!stream.eof() && !text.empty()) section.fail("dist is '" + text + "', expected numbers");
}

CameraCalibration readCamera(const CConfigFileBase& ini, const std::string& name) {
  IniSection section(ini, name);
  CameraCalibration calibration;
  const auto optics = readAllOf<6>(section, {"cols", "rows", "fx", "fy", "cx", "cy"});
  mrpt::img::TCamera camera;
  readDistortion(section, camera);
  if (optics) {
    camera.ncols = static_cast<unsigned>((*optics)[0]);
    camera.nrows = static_cast<unsigned>((*optics)[1]);
    camera.setIntrinsicParamsFromValues((*optics)[2], (*optics)[3], (*optics)[4], (*optics)[5]);
    calibration.intrinsics = camera;
  }
  const auto pose =
      readAllOf<6>(section, {"pose_x", "pose_y", "pose_z", "pose_yaw", "pose_pitch", "pose_roll"});
  section.finish();
  using mrpt::DEG2RAD;
  if (pose)
    calibration.T_robot_camera =
        mrpt::poses::CPose3D((*pose)[0], (*pose)[1], (*pose)[2], DEG2RAD((*pose)[3]),
                             DEG2RAD((*pose)[4]), DEG2RAD((*pose)[5]));
  return calibration;
}

void readCameras(const CConfigFileBase& ini, Config& config) {
  IniSection section(ini, "cameras");
  section.read("tolerance", config.cameras.tolerance);
  section.read("occlusionParallax", config.cameras.occlusionParallax);
  section.finish();
  std::vector<std::string> names;
  ini.getAllSections(names);
  for (const std::string& name : names)
    if (isCameraSection(name))
      config.cameras.calibrations[name.substr(kCameraPrefix.size())] = readCamera(ini, name);
  config.cameras.validate();
}

}  // namespace

bool isCameraSection(const std::string& section) { return section.rfind(kCameraPrefix, 0) == 0; }

void readLabelConfig(const CConfigFileBase& ini, Config& config) {
  readLabels(ini, config);
  readCameras(ini, config);
  config.cameras.skipProblems = config.stream.onProblem == ScanStreamOptions::OnProblem::Skip;
  config.insertion.conversion.occlusionParallax = config.cameras.occlusionParallax;
}

}  // namespace rawlog2semantic_map
