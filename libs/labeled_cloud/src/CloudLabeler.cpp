#include <labeled_cloud/CloudLabeler.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <stdexcept>

#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include "ObservationName.h"
#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::poses::CPose3D;
using Time = Trajectory::Time;

void CloudLabelerOptions::describe(strict_files::OptionList& list) {
  using strict_files::atLeast;
  list.add("tolerance", tolerance, "s", atLeast(0).orInfinite(),
           "largest time between a scan and the picture that labels it");
  list.add(
      "occlusion_parallax", occlusionParallax, "pixels", atLeast(0),
      "how far a point in front must shift against one behind it, between the sensor's and the "
      "camera's view, to hide it; 0: nothing is hidden");
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

std::vector<CloudLabeler::Picture*> CloudLabeler::waitingWith(Picture& picture) {
  std::vector<Picture*> waiting = {&picture};
  for (auto& [camera, pictures] : m_pictures)
    for (Picture& p : pictures)
      if (waiting.size() < m_labeler->batch() && !p.loaded && p.time() >= picture.time() &&
          &p != &picture)
        waiting.push_back(&p);
  return waiting;
}

void CloudLabeler::load(Picture& picture) {
  const auto pictures = waitingWith(picture);
  std::vector<const CObservation*> observations;
  for (Picture* p : pictures) {
    p->loaded = true;
    observations.push_back(p->observation.get());
  }
  auto labels = m_labeler->label(observations);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Picture& p = *pictures[i];
    const auto known = m_options.calibrations.find(p.observation->sensorLabel);
    const CameraCalibration own =
        known == m_options.calibrations.end() ? CameraCalibration() : known->second;
    const ColorImage color = colorImageOf(*p.observation);
    p.camera = own.intrinsics.value_or(color.camera);
    p.T_robot_camera = own.T_robot_camera.value_or(color.T_robot_camera);
    p.labels = std::move(labels[i]);
  }
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
                                      seen.camera, m_options.occlusionParallax);
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

}  // namespace labeled_cloud
