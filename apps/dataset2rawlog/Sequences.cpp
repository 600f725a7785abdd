#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/IniSection.h>
#include <strict_files/OptionList.h>
#include <strict_files/OutputFiles.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "Conversion.h"
#include "poses/Poses.h"

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
  double depthFactor = 5000;
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

/** Reads camera.ini: MRPT's section [CAMERA_PARAMS] and in it depth_factor.
 * \throw std::runtime_error naming the file and what is missing. */
DepthCamera readCamera(const fs::path& file) try {
  if (!fs::is_regular_file(file))
    throw std::runtime_error(
        "cannot be opened; it has the camera's fx, fy, cx, cy and depth_factor");
  const mrpt::config::CConfigFile config(file.string());
  DepthCamera camera;
  double number = 0;
  strict_files::OptionList numbers;  // MRPT's reader does not say which one is none
  for (const char* key : {"fx", "fy", "cx", "cy"}) numbers.add(key, number, "pixels", "");
  numbers.add("depth_factor", camera.depthFactor, "", strict_files::above(0), "");
  strict_files::IniSection(config, "CAMERA_PARAMS").read(numbers);
  camera.intrinsics.loadFromConfigFile("CAMERA_PARAMS", config);
  return camera;
} catch (const std::invalid_argument&) {  // of MRPT's reader of lists
  throw std::runtime_error(file.string() + ": resolution, dist: expected lists as [640 480]");
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
    const auto labelFile = labeled_cloud::nearestIn(labels, seconds, kTimeTolerance);
    if (!T_world_optical || (conversion.labels && !labelFile)) {
      output.skip();
      continue;
    }
    CObservation3DRangeScan scan = readDepth(file, camera);
    scan.timestamp = time;
    if (const auto image = labeled_cloud::nearestIn(color, seconds, kTimeTolerance))
      addColor(*image, scan);
    output.writePose(time, *T_world_optical + opticalFromForward());
    std::optional<LabelImage> pixels;
    if (labelFile) pixels = labeled_cloud::readLabelImage(*labelFile, table);
    output.writeDepth(scan, std::move(pixels));
  }
  return output.finish();
}

using semantic_types::LabeledCloud;
using strict_files::numbersOf;

namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Matrix34 readProjection(const fs::path& calib) {
  for (const TextLine& line : readLines(calib)) {
    if (line.text.rfind("P2:", 0) != 0) continue;
    const auto numbers = numbersOf(line, 12);
    const Matrix34 P = Eigen::Map<const Matrix34>(numbers.data());
    if (P(0, 0) > 0 && P(1, 1) > 0 && P(2, 2) == 1) return P;
    throw std::runtime_error(line.where + ": no projection of a camera");
  }
  throw std::runtime_error(calib.string() + ": no line 'P2:'");
}

/** The left color camera of a sequence in KITTI's layout: `P2` of calib.txt and image_2/. Its
 * images stay files of their own, copied beside the rawlog. */
class KittiCamera {
 public:
  /** \param rawlog Images go into imagesOf(rawlog), in finish().
   * \throw std::runtime_error naming the file and what is missing or malformed. */
  KittiCamera(const fs::path& sequence, const Eigen::Isometry3d& T_camera0_lidar,
              const fs::path& rawlog)
      : m_source(sequence / "image_2"), m_target(imagesOf(rawlog)) {
    const Matrix34 P = readProjection(sequence / "calib.txt");
    const Eigen::Matrix3d K = P.leftCols<3>();
    // P2 = K [I | t] takes points of the first camera: the color camera sees them shifted by t.
    const Eigen::Isometry3d T_camera2_lidar =
        Eigen::Translation3d(K.inverse() * P.col(3)) * T_camera0_lidar;
    m_observation.sensorLabel = "image_2";
    m_observation.cameraPose = labeled_cloud::toMrpt(T_camera2_lidar.inverse());
    m_observation.cameraParams.setIntrinsicParamsFromValues(K(0, 0), K(1, 1), K(0, 2), K(1, 2));
  }

  /** The image of this name. \throw std::runtime_error naming a file that is missing or no image.
   */
  const mrpt::obs::CObservationImage& observe(const std::string& name,
                                              mrpt::Clock::time_point time) {
    const fs::path file = m_source / (name + ".png");
    const cv::Mat image = labeled_cloud::readImageFile(file, labeled_cloud::ImageKinds::All);
    m_names.push_back(file.filename().string());
    fs::copy_file(file, m_target.staged(m_names.back()), fs::copy_options::overwrite_existing);
    m_observation.timestamp = time;
    m_observation.cameraParams.ncols = static_cast<unsigned>(image.cols);
    m_observation.cameraParams.nrows = static_cast<unsigned>(image.rows);
    m_observation.image.setExternalStorage(m_names.back());
    return m_observation;
  }
  /** Puts the images that were observed beside the rawlog. \throw std::runtime_error naming one */
  void finish() { m_target.commit(m_names); }

 private:
  fs::path m_source;
  strict_files::OutputFolder m_target;
  std::vector<std::string> m_names;
  mrpt::obs::CObservationImage m_observation;  ///< the last one
};

/** `Tr` of calib.txt: T_camera_lidar. */
Eigen::Isometry3d readLidarToCamera(const fs::path& file) {
  for (const TextLine& line : readLines(file))
    if (line.text.rfind("Tr:", 0) == 0) return poses::poseOfMatrix(line);
  throw std::runtime_error(file.string() + ": no line 'Tr:'");
}

template <typename T>
std::vector<T> readBinary(const fs::path& file, std::size_t valuesEach) {
  const std::string bytes = strict_files::readText(file);
  if (bytes.empty() || bytes.size() % (valuesEach * sizeof(T)) != 0)
    throw std::runtime_error(file.string() + ": " + std::to_string(bytes.size()) +
                             " bytes, expected a multiple of " +
                             std::to_string(valuesEach * sizeof(T)));
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

LabeledCloud readPoints(const fs::path& file) {
  const auto xyzr = readBinary<float>(file, 4);
  LabeledCloud cloud;
  for (std::size_t i = 0; i < xyzr.size(); i += 4)
    cloud.points.emplace_back(xyzr[i], xyzr[i + 1], xyzr[i + 2]);
  return cloud;
}

void readLabels(const fs::path& file, const ClassTable& table, LabeledCloud& cloud) {
  const auto labels = readBinary<std::uint32_t>(file, 1);
  if (labels.size() != cloud.size())
    throw std::runtime_error(file.string() + ": " + std::to_string(labels.size()) + " labels for " +
                             std::to_string(cloud.size()) + " points");
  for (std::size_t i = 0; i < labels.size(); ++i) try {
      cloud.classes.push_back(table.fromRaw(labels[i] & 0xffff));  // above: the instance's number
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ": point " + std::to_string(i) + ": " + e.what());
    }
}

/** SemanticKITTI's poses, or KITTI's own: sequences/00 has poses/00.txt. */
fs::path posesOf(const fs::path& sequence) {
  const fs::path folder = fs::weakly_canonical(sequence);
  const fs::path kittis =
      folder.parent_path().parent_path() / "poses" / (folder.filename().string() + ".txt");
  const fs::path file = sequence / "poses.txt";
  return !fs::exists(file) && fs::exists(kittis) ? kittis : file;
}

}  // namespace

Summary convertSemanticKitti(const fs::path& sequence, const Conversion& conversion) {
  const ClassTable table =
      conversion.labels ? semantic_types::loadClassTable(conversion.classes) : ClassTable();
  const Eigen::Isometry3d Tr = readLidarToCamera(sequence / "calib.txt");
  const auto lines = readLines(posesOf(sequence));
  const auto times = readLines(sequence / "times.txt");
  if (lines.size() != times.size())
    throw std::runtime_error((sequence / "times.txt").string() + ": " +
                             std::to_string(times.size()) + " times for " +
                             std::to_string(lines.size()) + " poses");
  Output output(conversion, table);
  std::optional<KittiCamera> camera;
  if (conversion.images) camera.emplace(sequence, Tr, conversion.output);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!output.wants(i, lines.size())) continue;
    const auto time = timeOf(numbersOf(times[i], 1)[0], times[i]);
    const Eigen::Isometry3d T_map_lidar = Tr.inverse() * poses::poseOfMatrix(lines[i]) * Tr;
    const std::string name = sixDigits(i);
    output.writePose(time, labeled_cloud::toMrpt(T_map_lidar));
    if (camera) output.writeOther(camera->observe(name, time));
    LabeledCloud cloud = readPoints(sequence / "velodyne" / (name + ".bin"));
    if (conversion.labels) readLabels(sequence / "labels" / (name + ".label"), table, cloud);
    output.writeCloud(time, "velodyne", std::move(cloud));
  }
  if (camera) camera->finish();
  return output.finish();
}

}  // namespace dataset2rawlog
