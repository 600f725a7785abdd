#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "Conversion.h"

namespace dataset2rawlog {

namespace fs = std::filesystem;
using labeled_cloud::ImageKinds;
using labeled_cloud::LabelImage;
using labeled_cloud::readImageFile;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using semantic_types::ClassTable;
using strict_files::readLines;
using strict_files::TextLine;

namespace {

/** Largest difference between a depth image's time and that of what belongs to it, s. */
constexpr double kTimeTolerance = 0.02;

/** Image files by their time in seconds. */
using ImageList = std::map<double, std::filesystem::path>;

struct DepthCamera {
  mrpt::img::TCamera intrinsics;
  /** Value of a depth image's pixel at one meter. */
  double depthFactor = 0;
};

/** Reads "time file" lines; the files are relative to the list's folder.
 * \throw std::runtime_error naming file and line. */
ImageList readImageList(const fs::path& list) {
  ImageList images;
  for (const TextLine& line : readLines(list)) {
    std::istringstream stream(line.text);
    const strict_files::ClassicNumbers classic(stream);
    double time;
    std::string file;
    if (!(stream >> time >> file))
      throw std::runtime_error(line.where + ": expected 'time file', found '" + line.text + "'");
    timeOf(time, line);
    images[time] = list.parent_path() / file;
  }
  if (images.empty()) throw std::runtime_error(list.string() + ": no image in this list");
  return images;
}

/** The image nearest to a time, within kTimeTolerance. */
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

/** Reads camera.ini: MRPT's section [CAMERA_PARAMS] and in it depth_factor.
 * \throw std::runtime_error naming the file and what is missing. */
DepthCamera readCamera(const fs::path& file) try {
  if (!fs::is_regular_file(file))
    throw std::runtime_error(
        "cannot be opened; it has the camera's fx, fy, cx, cy and depth_factor");
  const mrpt::config::CConfigFile config(file.string());
  DepthCamera camera;
  camera.intrinsics.loadFromConfigFile("CAMERA_PARAMS", config);
  camera.depthFactor = config.read_double("CAMERA_PARAMS", "depth_factor", 5000);
  if (!(camera.depthFactor > 0)) throw std::runtime_error("depth_factor must be above 0");
  return camera;
} catch (const std::exception& e) {
  throw std::runtime_error(file.string() + ": " + strict_files::messageOf(e));
}

/** A depth image of 16 bits as an observation.
 * \throw std::runtime_error naming a file that is something else. */
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

/** Gives the observation its color image.
 * \throw std::runtime_error naming a file that is no image. */
void addColor(const fs::path& file, CObservation3DRangeScan& scan) {
  scan.intensityImage = mrpt_compat::toMrpt(readImageFile(file, ImageKinds::All));
  scan.hasIntensityImage = true;
}

/** The camera's frame with x forward, y left, z up, in the optical one (x right, y down, z
 * forward). */
CPose3D opticalFromForward() {
  using mrpt::DEG2RAD;
  return -CPose3D(0, 0, 0, DEG2RAD(-90.0), 0, DEG2RAD(-90.0));
}

}  // namespace

Summary convertTumSequence(const fs::path& folder, const Conversion& conversion) {
  const DepthCamera camera = readCamera(folder / "camera.ini");
  const ImageList depth = readImageList(folder / "depth.txt");
  const auto trajectory =
      labeled_cloud::loadTumTrajectory(folder / "groundtruth.txt", {kTimeTolerance, 1.0});
  ImageList color, labels;
  ClassTable table;
  if (conversion.labels) labels = readImageList(folder / "label.txt");
  if (fs::exists(folder / "rgb.txt")) color = readImageList(folder / "rgb.txt");
  if (!conversion.classes.empty()) table = semantic_types::loadClassTable(conversion.classes);
  // Colors must stay what they were: a network, or a palette, may depend on them.
  mrpt_compat::writeImagesWithoutLoss();
  Output output(conversion, table);
  std::size_t frame = 0;
  for (const auto& [seconds, file] : depth) {
    if (!output.wants(frame++, depth.size())) continue;
    const auto time = mrpt::Clock::fromDouble(seconds);
    const auto T_world_optical = trajectory.at(time);
    const auto labelFile = nearest(labels, seconds);
    if (!T_world_optical || (conversion.labels && !labelFile)) {
      output.skip();
      continue;
    }
    CObservation3DRangeScan scan = readDepth(file, camera);
    scan.timestamp = time;
    if (const auto image = nearest(color, seconds)) addColor(*image, scan);
    output.writePose(time, *T_world_optical + opticalFromForward());
    std::optional<LabelImage> pixels;
    if (labelFile) pixels = labeled_cloud::readLabelImage(*labelFile, table);
    output.writeDepth(scan, std::move(pixels));
  }
  return output.finish();
}

}  // namespace dataset2rawlog
