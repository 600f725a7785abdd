#include <labeled_cloud/ScanConverter.h>
#include <mrpt/core/bits_math.h>

#include <stdexcept>

#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include "PointGrid.h"
#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::img::TCamera;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;

namespace {

/** Looking along x with z up becomes looking along z with y down. */
CPose3D opticalFrame() {
  using mrpt::DEG2RAD;
  return {0, 0, 0, DEG2RAD(-90.0), 0, DEG2RAD(-90.0)};
}

std::string size(int cols, int rows) { return std::to_string(cols) + " x " + std::to_string(rows); }

void checkSize(const LabelImage& labels, int rows, int cols, const char* what) {
  if (labels.pictureRows() == rows && labels.pictureCols() == cols) return;
  throw std::invalid_argument(labels.origin + ": the label image has " +
                              size(labels.pictureCols(), labels.pictureRows()) + " pixels, " +
                              what + " " + size(cols, rows));
}

bool isAligned(const CObservation3DRangeScan& o) {
  return o.doDepthAndIntensityCamerasCoincide() && o.cameraParams == o.cameraParamsIntensity;
}

/** Each point takes the label of the pixel it was made of. */
void labelInPlace(const PointGrid& grid, const std::vector<std::size_t>& pixels,
                  const LabelImage& labels, PointLabels& to) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto cell = labels.cellAt(pixels[i] % grid.cols, pixels[i] / grid.cols);
    if (cell) to.take(i, labels, *cell);
  }
}

/** Each point takes the label of the pixel at which the camera sees it. */
void labelByProjection(const PointGrid& grid, const std::vector<std::size_t>& pixels,
                       const LabeledPicture& picture, double parallax, PointLabels& to) {
  const auto T_camera_sensor = toEigen(picture.T_sensor_camera).inverse();
  const auto seen = visiblePixels(grid.points, T_camera_sensor, picture.camera, parallax);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Eigen::Vector2f& pixel = seen[pixels[i]];
    if (const auto cell = picture.labels.cellAt(pixel.x(), pixel.y()))
      to.take(i, picture.labels, *cell);
  }
}

}  // namespace

void ScanConverter::addLabels(const CObservation3DRangeScan& observation, const PointGrid& grid,
                              const std::vector<std::size_t>& pixels, LabelImage labels,
                              LabeledScan& scan) {
  const bool ofColor = labels.view == LabelImage::View::Color && !isAligned(observation);
  LabeledPicture picture;
  picture.camera = ofColor ? observation.cameraParamsIntensity : observation.cameraParams;
  picture.T_sensor_camera = ofColor ? observation.relativePoseIntensityWRTDepth : opticalFrame();
  picture.labels = std::move(labels);
  PointLabels taken(pixels.size());
  if (ofColor) {
    checkSize(picture.labels, int(picture.camera.nrows), int(picture.camera.ncols),
              "the color camera is calibrated for");
    labelByProjection(grid, pixels, picture, m_options.occlusionParallax, taken);
  } else {
    checkSize(picture.labels, grid.rows, grid.cols, "the depth image");
    labelInPlace(grid, pixels, picture.labels, taken);
  }
  const auto confidences = taken.moveTo(scan.cloud);
  m_options.labels.apply(m_table.size(), confidences, scan.cloud);
  if (!m_keepPictures) return;
  if (observation.hasIntensityImage && (ofColor || isAligned(observation)))
    picture.image = observation.intensityImage.makeDeepCopy();
  scan.pictures.push_back(std::move(picture));
}

}  // namespace labeled_cloud
