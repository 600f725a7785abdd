#include <labeled_cloud/CloudLabeler.h>

#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/math/TPose3D.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::DEG2RAD;
using mrpt::obs::CObservation;
using mrpt::poses::CPose3D;
using strict_files::above;
using strict_files::atLeast;
using Time = Trajectory::Time;

void CloudLabelerOptions::describe(strict_files::OptionList& list) {
  using strict_files::atLeast;
  list.add("tolerance", tolerance, "s", atLeast(0).orInfinite(),
           "largest time between a scan and the picture that labels it");
}

void CloudLabelerOptions::validate() const {
  strict_files::checkOptions(*this, "CloudLabelerOptions");
}

struct CloudLabeler::Picture {
  CObservation::Ptr observation;
  CPose3D T_map_robot;
  /** Set when a scan needs the picture first. */
  bool loaded = false, usable = false;
  mrpt::img::TCamera camera;
  CPose3D T_robot_camera;
  std::optional<LabelImage> labels;

  Time time() const { return observation->timestamp; }
};

CloudLabeler::CloudLabeler(std::shared_ptr<ImageLabeler> labeler, int numClasses,
                           const LabelModel& model, const Trajectory& trajectory,
                           const CloudLabelerOptions& options)
    : m_labeler(std::move(labeler)),
      m_numClasses(numClasses),
      m_model(model),
      m_trajectory(trajectory),
      m_options(options) {
  m_options.validate();
  m_model.validate();
}

CloudLabeler::~CloudLabeler() = default;

namespace {

Time::duration seconds(double s) {
  return std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(s));
}

Time::duration apart(Time a, Time b) { return a < b ? b - a : a - b; }

}  // namespace

void CloudLabeler::addPicture(CObservation::Ptr picture) {
  const auto T_map_robot = m_trajectory.at(picture->timestamp);
  Picture added;
  added.T_map_robot = T_map_robot.value_or(CPose3D());
  added.loaded = !T_map_robot;  // without a pose it is of no use, but tells that its time is over
  added.observation = std::move(picture);
  m_pictures[added.observation->sensorLabel].push_back(std::move(added));
}

void CloudLabeler::forgetBefore(Time time) {
  for (auto& [camera, pictures] : m_pictures)
    while (!pictures.empty() && pictures.front().time() < time - 2 * seconds(m_options.tolerance) &&
           pictures.size() > 1)  // the last one tells how far the camera is
      pictures.pop_front();
}

bool CloudLabeler::sawAllCamerasAt(Time time) const {
  return !m_pictures.empty() &&
         std::all_of(m_pictures.begin(), m_pictures.end(),
                     [time](const auto& of) { return of.second.back().time() >= time; });
}

std::vector<CloudLabeler::Picture*> CloudLabeler::nearestPictures(Time time) {
  std::vector<Picture*> nearest;
  const auto nearer = [time](const Picture& a, const Picture& b) {
    return apart(a.time(), time) < apart(b.time(), time);
  };
  for (auto& [camera, pictures] : m_pictures) {
    Picture& best = *std::min_element(pictures.begin(), pictures.end(), nearer);
    if (apart(best.time(), time) <= seconds(m_options.tolerance)) nearest.push_back(&best);
  }
  std::stable_sort(nearest.begin(), nearest.end(),
                   [&](const Picture* a, const Picture* b) { return nearer(*a, *b); });
  return nearest;
}

void CloudLabeler::load(Picture& picture) {
  picture.loaded = true;
  picture.labels = m_labeler->label(*picture.observation);
  const auto known = m_options.calibrations.find(picture.observation->sensorLabel);
  const CameraCalibration own =
      known == m_options.calibrations.end() ? CameraCalibration() : known->second;
  const ColorImage color = colorImageOf(*picture.observation);
  picture.camera = own.intrinsics.value_or(color.camera);
  picture.T_robot_camera = own.T_robot_camera.value_or(color.T_robot_camera);
}

namespace {

void checkFit(const LabelImage& labels, const mrpt::img::TCamera& camera) {
  if (!(camera.fx() > 0 && camera.fy() > 0))
    throw std::invalid_argument("its camera is not calibrated");
  const auto size = [](auto cols, auto rows) {
    return std::to_string(cols) + " x " + std::to_string(rows);
  };
  if (labels.pictureCols() != int(camera.ncols) || labels.pictureRows() != int(camera.nrows))
    throw std::invalid_argument(
        labels.origin + ": labels of " + size(labels.pictureCols(), labels.pictureRows()) +
        " pixels, but the camera is calibrated for " + size(camera.ncols, camera.nrows));
}

}  // namespace

bool CloudLabeler::prepare(Picture& picture) try {
  if (!picture.loaded) load(picture);
  if (!picture.labels) return false;
  if (!picture.usable) checkFit(*picture.labels, picture.camera);
  return picture.usable = true;
} catch (const std::exception& e) {
  const std::string problem = nameOf(*picture.observation) + ": " + strict_files::messageOf(e);
  picture.labels.reset();
  if (!m_options.skipProblems) throw std::runtime_error(problem);
  m_problems.push_back(problem);
  return false;
}

LabeledPicture CloudLabeler::seenFrom(const Picture& picture, const LabeledScan& scan,
                                      const CPose3D& T_map_robot) const {
  LabeledPicture seen;
  seen.camera = picture.camera;
  const CPose3D T_map_camera = picture.T_map_robot + picture.T_robot_camera;
  seen.T_sensor_camera = T_map_camera - (T_map_robot + scan.T_robot_sensor);
  return seen;
}

void CloudLabeler::label(LabeledScan& scan, const CPose3D& T_map_robot, bool keepPictures) {
  const std::size_t n = scan.cloud.size();
  PointLabels labels(n);
  std::vector<bool> done(n, false);
  scan.labelsMissing = true;
  for (Picture* picture : nearestPictures(scan.timestamp)) {
    if (!prepare(*picture)) continue;
    scan.labelsMissing = false;
    LabeledPicture seen = seenFrom(*picture, scan, T_map_robot);
    const auto pixels = visiblePixels(scan.cloud.points, toEigen(seen.T_sensor_camera).inverse(),
                                      seen.camera, kOcclusionParallax);
    for (std::size_t i = 0; i < n; ++i) {
      const auto cell =
          done[i] ? std::nullopt : picture->labels->cellAt(pixels[i].x(), pixels[i].y());
      if (cell) labels.take(i, *picture->labels, *cell), done[i] = true;
    }
    if (!keepPictures) continue;
    seen.labels = *picture->labels;
    seen.image = colorImageOf(*picture->observation).image.makeDeepCopy();
    scan.pictures.push_back(std::move(seen));
  }
  const auto confidences = labels.moveTo(scan.cloud);
  m_model.apply(m_numClasses, confidences, scan.cloud);
  scan.countLabels();
}

namespace {

struct Named {
  const char* name;
  const std::optional<double>& value;
};

/** Whether these values are given. \throw std::invalid_argument some are, some are not. */
bool areGiven(const std::vector<Named>& values) {
  const auto isGiven = [](const Named& n) { return n.value.has_value(); };
  const auto missing = std::find_if_not(values.begin(), values.end(), isGiven);
  if (missing == values.end()) return true;
  if (std::none_of(values.begin(), values.end(), isGiven)) return false;
  throw std::invalid_argument(std::string(missing->name) + " is missing");
}

}  // namespace

void CameraDescription::describe(strict_files::OptionList& list) {
  list.add("cols", cols, "pixels", atLeast(1), "size of the images");
  list.add("rows", rows, "pixels", atLeast(1), "size of the images");
  list.add("fx", fx, "pixels", above(0), "focal length");
  list.add("fy", fy, "pixels", above(0), "focal length");
  list.add("cx", cx, "pixels", "principal point");
  list.add("cy", cy, "pixels", "principal point");
  list.add("dist", dist, "",
           "coefficients of the lens (plumb_bob) in MRPT's order, separated by spaces");
  list.add("pose_x", x, "m", "place of the camera on the robot");
  list.add("pose_y", y, "m", "place of the camera on the robot");
  list.add("pose_z", z, "m", "place of the camera on the robot");
  list.add("pose_yaw", yaw, "degrees", "yaw of the optical frame: x right, y down, z forward");
  list.add("pose_pitch", pitch, "degrees", "pitch of the optical frame");
  list.add("pose_roll", roll, "degrees", "roll of the optical frame");
}

CameraCalibration CameraDescription::calibration() const {
  CameraCalibration calibration;
  mrpt::img::TCamera camera;
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  std::istringstream stream(dist);
  const strict_files::ClassicNumbers classic(stream);
  std::size_t count = 0;
  for (double k; stream >> k && count < camera.dist.size();) camera.dist[count++] = k;
  if (!stream.eof() && !dist.empty())
    throw std::invalid_argument("dist is '" + dist + "', expected numbers");
  if (areGiven({{"cols", cols}, {"rows", rows}, {"fx", fx}, {"fy", fy}, {"cx", cx}, {"cy", cy}})) {
    camera.ncols = static_cast<unsigned>(*cols);
    camera.nrows = static_cast<unsigned>(*rows);
    camera.setIntrinsicParamsFromValues(*fx, *fy, *cx, *cy);
    calibration.intrinsics = camera;
  }
  if (areGiven({{"pose_x", x},
                {"pose_y", y},
                {"pose_z", z},
                {"pose_yaw", yaw},
                {"pose_pitch", pitch},
                {"pose_roll", roll}}))
    calibration.T_robot_camera =
        mrpt::poses::CPose3D(*x, *y, *z, DEG2RAD(*yaw), DEG2RAD(*pitch), DEG2RAD(*roll));
  return calibration;
}

}  // namespace labeled_cloud
