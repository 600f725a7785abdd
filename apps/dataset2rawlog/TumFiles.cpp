#include "TumFiles.h"

#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt_compat/Images.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>

#include <strict_files/TextFile.h>

namespace dataset2rawlog {

using labeled_cloud::ImageKinds;
using labeled_cloud::readImageFile;
using strict_files::readLines;
using strict_files::TextLine;

namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

namespace {

void checkTime(double seconds, const TextLine& line) try {
  labeled_cloud::timeOfSeconds(seconds);
} catch (const std::invalid_argument& e) {
  throw std::runtime_error(line.where + ": " + e.what());
}

}  // namespace

ImageList readImageList(const fs::path& list) {
  ImageList images;
  for (const TextLine& line : readLines(list)) {
    std::istringstream stream(line.text);
    const strict_files::ClassicNumbers classic(stream);
    double time;
    std::string file;
    if (!(stream >> time >> file))
      throw std::runtime_error(line.where + ": expected 'time file', found '" + line.text + "'");
    checkTime(time, line);
    images[time] = list.parent_path() / file;
  }
  if (images.empty()) throw std::runtime_error(list.string() + ": no image in this list");
  return images;
}

std::optional<fs::path> nearest(const ImageList& images, double time) {
  std::optional<fs::path> best;
  double least = kTimeTolerance;
  const auto consider = [&](const auto& image) {
    const double apart = std::abs(image.first - time);
    if (apart <= least) least = apart, best = image.second;
  };
  const auto after = images.lower_bound(time);
  if (after != images.end()) consider(*after);
  if (after != images.begin()) consider(*std::prev(after));
  return best;
}

DepthCamera readCamera(const fs::path& file) try {
  if (!fs::is_regular_file(file)) throw std::runtime_error("cannot be opened");
  const mrpt::config::CConfigFile config(file.string());
  DepthCamera camera;
  camera.intrinsics.loadFromConfigFile("CAMERA_PARAMS", config);
  camera.depthFactor = config.read_double("CAMERA_PARAMS", "depth_factor", 5000);
  if (!(camera.depthFactor > 0)) throw std::runtime_error("depth_factor must be above 0");
  return camera;
} catch (const std::exception& e) {
  throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
}

CObservation3DRangeScan readDepth(const fs::path& file, const DepthCamera& camera) {
  const cv::Mat depth = readImageFile(file, ImageKinds::All);
  if (depth.type() != CV_16UC1 || depth.empty())
    throw std::runtime_error(file.string() + ": expected a depth image of 16 bits");
  CObservation3DRangeScan scan;
  scan.sensorLabel = "camera";
  scan.cameraParams = scan.cameraParamsIntensity = camera.intrinsics;
  scan.hasRangeImage = true;
  scan.rangeUnits = static_cast<float>(1 / camera.depthFactor);
  scan.maxRange = 65535 * scan.rangeUnits;
  scan.rangeImage_setSize(depth.rows, depth.cols);
  for (int row = 0; row < depth.rows; ++row)
    std::copy_n(depth.ptr<std::uint16_t>(row), depth.cols, &scan.rangeImage(row, 0));
  return scan;
}

void addColor(const fs::path& file, CObservation3DRangeScan& scan) {
  scan.intensityImage = mrpt_compat::toMrpt(readImageFile(file, ImageKinds::All));
  scan.hasIntensityImage = true;
}

}  // namespace dataset2rawlog
