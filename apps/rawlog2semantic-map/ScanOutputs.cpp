#include "ScanOutputs.h"

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <map_pictures/MapPictures.h>
#include <mrpt/core/format.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt_compat/Drawing.h>
#include <opencv2/imgproc.hpp>

#include <cstdint>
#include <map>
#include <stdexcept>

#include "label_overlay/LabelOverlay.h"

namespace rawlog2semantic_map {

ScanLog::ScanLog(const std::filesystem::path& file, const semantic_types::ClassTable& classes)
    : m_writer(file) {
  for (int id = 1; id <= classes.size(); ++id)
    m_classNames.push_back(classes.name(static_cast<semantic_types::ClassId>(id)));
}

void ScanLog::write(const labeled_cloud::LabeledScan& scan,
                    const mrpt::poses::CPose3D& T_map_robot) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = scan.timestamp;
  pose.sensorLabel = "robot";
  pose.pose.mean = T_map_robot;
  m_writer.write(pose);
  labeled_cloud::CObservationLabeledCloud cloud;
  cloud.timestamp = scan.timestamp;
  cloud.sensorLabel = scan.sensorLabel;
  cloud.sensorPose = scan.T_robot_sensor;
  cloud.classNames = m_classNames;
  cloud.cloud = scan.cloud;
  cloud.times = scan.times;
  m_writer.write(cloud);
}

using labeled_cloud::LabeledPicture;
using labeled_cloud::LabeledScan;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

cv::Mat3b withPoints(cv::Mat3b image, const LabeledPicture& picture,
                     const semantic_types::LabeledCloud& cloud, const ClassTable& classes) {
  image = image / 2;
  const auto T_camera_sensor = labeled_cloud::toEigen(picture.T_sensor_camera).inverse();
  const auto pixels =
      labeled_cloud::visiblePixels(cloud.points, T_camera_sensor, picture.camera, 0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels[i].allFinite()) continue;
    const ClassId id = cloud.classes.empty() ? kNoClass : cloud.classes[i];
    cv::circle(image, cv::Point(cvRound(pixels[i].x()), cvRound(pixels[i].y())),
               id == kNoClass ? 0 : 1, cv::Scalar(label_overlay::pixelOf(id, classes)), cv::FILLED);
  }
  return image;
}

}  // namespace

Preview::Preview(const std::filesystem::path& folder, const ClassTable& classes)
    : m_folder(folder), m_classes(classes) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be created: " + error.message());
}

std::string Preview::nameOf(std::size_t i) { return mrpt::format("%06zu.png", i); }

void Preview::write(const LabeledScan& scan) {
  if (scan.pictures.empty()) return;
  auto cloud = scan.cloud;
  labeled_cloud::LabelModel hard;
  hard.kind = labeled_cloud::LabelModel::Kind::Hard;
  hard.apply(m_classes.size(), {}, cloud);
  for (const LabeledPicture& picture : scan.pictures) {
    const cv::Mat3b image = label_overlay::photograph(picture);
    cv::Mat sheet;
    cv::vconcat(label_overlay::withLabels(image.clone(), picture, m_classes),
                withPoints(image.clone(), picture, cloud, m_classes), sheet);
    map_pictures::savePicture(sheet, m_folder / nameOf(m_written++));
  }
}

namespace {

constexpr float kPointSize = 2;  // pixels

/** For points of a class, halfway from its color to white: they show upon its voxels. */
mrpt_compat::drawing::CPointCloud::Ptr pointsOf(semantic_types::ClassId id,
                                                const semantic_types::ClassTable& classes) {
  const auto points = mrpt_compat::drawing::CPointCloud::Create();
  points->setPointSize(kPointSize);
  const auto c = semantic_types::colorOf(id, classes);
  const auto pale = [](int x) { return std::uint8_t((x + 255) / 2); };
  points->setColor_u8({pale(c.r), pale(c.g), pale(c.b)});
  return points;
}

/** The time that the compressed tree took, if it is kept. */
std::string changeTime(const Summary& summary) {
  const auto& times = summary.abstraction.changeTimes;
  return times.empty() ? std::string() : mrpt::format(", tree %.1f", times.back());
}

std::vector<std::string> lines(const LabeledScan& scan, const Summary& summary,
                               const semantic_octree::SemanticOcTree& map) {
  return {std::to_string(summary.insertionTimes.size()) + " scans, " + scan.sensorLabel,
          std::to_string(scan.counts.points) + " points, " + std::to_string(scan.counts.labeled) +
              " with a class",
          mrpt::format("ms: made %.1f,", summary.conversionTimes.back()) +
              mrpt::format(" inserted %.1f", summary.insertionTimes.back()) + changeTime(summary),
          std::to_string(map.getNumLeafNodes()) + " leaves"};
}

}  // namespace

LiveScans::LiveScans(const semantic_octree::SemanticOcTree& map, const StopRequest& stop,
                     bool paused)
    : m_map(map), m_window(map_window::LiveMap::open("rawlog2semantic-map", map)) {
  m_window->stopWhen([&stop] { return stop.pending(); });
  if (paused) m_window->pause();
}

void LiveScans::show(const LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot,
                     const Summary& summary) {
  const Eigen::Isometry3d T_map_sensor = labeled_cloud::toEigen(T_map_robot + scan.T_robot_sensor);
  Eigen::AlignedBox3d seen(T_map_sensor.translation());
  std::map<semantic_types::ClassId, mrpt_compat::drawing::CPointCloud::Ptr> points;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const Eigen::Vector3d place = T_map_sensor * scan.cloud.points[i].cast<double>();
    seen.extend(place);
    const auto id = scan.cloud.classes.empty() ? semantic_types::kNoClass : scan.cloud.classes[i];
    auto& ofClass = points[id];
    if (!ofClass) ofClass = pointsOf(id, m_map.classes());
    ofClass->insertPoint(float(place.x()), float(place.y()), float(place.z()));
  }
  m_window->marks().clear();
  for (const auto& [id, ofClass] : points) m_window->marks().insert(ofClass);
  if (!scan.pictures.empty()) {
    const labeled_cloud::LabeledPicture& picture = scan.pictures.front();
    m_window->showPicture(label_overlay::labeledImage(picture, m_map.classes()));
  }
  m_window->changed(seen);
  m_window->say(lines(scan, summary, m_map));
  m_window->show(0);
}

}  // namespace rawlog2semantic_map
