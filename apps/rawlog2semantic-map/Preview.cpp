#include "Preview.h"

#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <map_pictures/MapPictures.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "label_overlay/LabelOverlay.h"

namespace rawlog2semantic_map {

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

std::string Preview::nameOf(std::size_t i) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu.png", i);
  return name;
}

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

}  // namespace rawlog2semantic_map
