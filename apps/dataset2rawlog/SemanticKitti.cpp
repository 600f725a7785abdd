#include <labeled_cloud/Trajectory.h>
#include <semantic_types/ClassTable.h>

#include <Eigen/Geometry>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <strict_files/TextFile.h>
#include "Conversion.h"
#include "KittiCamera.h"
#include "Output.h"
#include "poses/Poses.h"

namespace dataset2rawlog {

using strict_files::numbersOf;
using strict_files::readLines;
using strict_files::TextLine;

namespace fs = std::filesystem;
using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

namespace {

mrpt::Clock::time_point timeOf(const TextLine& line) {
  const double seconds = numbersOf(line, 1)[0];
  try {
    return labeled_cloud::timeOfSeconds(seconds);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(line.where + ": " + e.what());
  }
}

/** `Tr` of calib.txt: T_camera_lidar. */
Eigen::Isometry3d readLidarToCamera(const fs::path& file) {
  for (const TextLine& line : readLines(file))
    if (line.text.rfind("Tr:", 0) == 0) return poses::poseOfMatrix(line);
  throw std::runtime_error(file.string() + ": no line 'Tr:'");
}

template <typename T>
std::vector<T> readBinary(const fs::path& file, std::size_t valuesEach) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be opened");
  const auto bytes = fs::file_size(file);
  if (bytes == 0 || bytes % (valuesEach * sizeof(T)) != 0)
    throw std::runtime_error(file.string() + ": " + std::to_string(bytes) +
                             " bytes, expected a multiple of " +
                             std::to_string(valuesEach * sizeof(T)));
  std::vector<T> values(bytes / sizeof(T));
  stream.read(reinterpret_cast<char*>(values.data()), bytes);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
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

std::string sixDigits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

}  // namespace

Summary convertSemanticKitti(const fs::path& sequence, const Conversion& conversion) {
  const ClassTable table =
      conversion.labels ? semantic_types::loadClassTable(conversion.classes) : ClassTable();
  const Eigen::Isometry3d Tr = readLidarToCamera(sequence / "calib.txt");
  const auto lines = readLines(sequence / "poses.txt");
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
    const auto time = timeOf(times[i]);
    const Eigen::Isometry3d T_map_lidar = Tr.inverse() * poses::poseOfMatrix(lines[i]) * Tr;
    const std::string name = sixDigits(i);
    output.writePose(time, mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_map_lidar.matrix())));
    if (camera) output.writeOther(camera->observe(name, time));
    LabeledCloud cloud = readPoints(sequence / "velodyne" / (name + ".bin"));
    if (conversion.labels) readLabels(sequence / "labels" / (name + ".label"), table, cloud);
    output.writeCloud(time, "velodyne", std::move(cloud));
  }
  if (camera) camera->finish();
  return output.finish();
}

}  // namespace dataset2rawlog
