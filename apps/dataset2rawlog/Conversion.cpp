#include "Conversion.h"

#include <labeled_cloud/PointFile.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <memory>
#include <regex>
#include <stdexcept>

namespace dataset2rawlog {

using labeled_cloud::LabelImage;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::TPixelLabelInfo;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kMaxClasses;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

mrpt::Clock::time_point timeOf(double seconds, const strict_files::TextLine& line) try {
  return labeled_cloud::timeOfSeconds(seconds);
} catch (const std::invalid_argument& e) {
  throw std::runtime_error(line.where + ": " + e.what());
}

std::string sixDigits(std::size_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

std::filesystem::path imagesOf(const std::filesystem::path& rawlog) {
  return std::filesystem::absolute(rawlog).parent_path() / (rawlog.stem().string() + "_Images");
}

namespace {

constexpr int kMaxPixelLabels = 64;

/** Bit c - 1 stands for class c, by its name. */
void setPixelLabels(const LabelImage& labels, const ClassTable& table,
                    CObservation3DRangeScan& scan) {
  auto info = std::make_shared<TPixelLabelInfo<kMaxPixelLabels / 8>>();
  info->setSize(labels.rows, labels.cols);
  for (int id = 1; id <= table.size(); ++id) info->setLabelName(id - 1, table.name(id));
  for (int row = 0, i = 0; row < labels.rows; ++row)
    for (int col = 0; col < labels.cols; ++col, ++i)
      if (labels.classes[i] != kNoClass) info->setLabel(row, col, labels.classes[i] - 1);
  scan.pixelLabels = info;
}

/** Gives the same label image to every scan. */
class OneImage : public labeled_cloud::ImageLabeler {
 public:
  explicit OneImage(const LabelImage& image) : m_image(image) {}
  std::optional<LabelImage> label(const mrpt::obs::CObservation&) override { return m_image; }

 private:
  LabelImage m_image;
};

std::size_t pointsOf(const CObservation3DRangeScan& scan) {
  const auto* pixels = scan.rangeImage.data();
  return scan.rangeImage.size() - std::count(pixels, pixels + scan.rangeImage.size(), 0);
}

}  // namespace

Output::Output(const Conversion& conversion, const semantic_types::ClassTable& table)
    : m_conversion(conversion),
      m_table(table),
      m_writer(conversion.output),
      m_noise(conversion.labelNoise, conversion.labelNoiseKind, conversion.seed, table.size()) {
  for (int id = 1; id <= table.size(); ++id) m_classNames.push_back(table.name(id));
}

bool Output::wants(std::size_t frame, std::size_t numFrames) {
  const FrameRange& range = m_conversion.frames;
  const std::size_t end = numFrames == 0 ? 0 : std::min(numFrames - 1, range.last) + 1;
  if (!m_progress) m_progress.emplace("Converting", end);
  m_progress->update(frame, std::to_string(m_summary.scans) + " scans");
  return range.contains(frame) && !(m_conversion.stop && m_conversion.stop->pending());
}

void Output::writePose(mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_map_robot) {
  mrpt::obs::CObservationRobotPose pose;
  pose.timestamp = time;
  pose.sensorLabel = "ground truth";
  pose.pose.mean = T_map_robot;
  m_T_map_robot = labeled_cloud::toEigen(T_map_robot);
  m_writer.write(pose);
}

void Output::writeCloud(mrpt::Clock::time_point time, const std::string& sensorLabel,
                        semantic_types::LabeledCloud cloud,
                        const mrpt::poses::CPose3D& T_robot_sensor, std::vector<float> times) {
  labeled_cloud::CObservationLabeledCloud observation;
  observation.timestamp = time;
  observation.sensorLabel = sensorLabel;
  observation.sensorPose = T_robot_sensor;
  observation.classNames = m_classNames;
  observation.cloud = std::move(cloud);
  observation.times = std::move(times);
  m_noise.apply(observation.cloud, m_T_map_robot * labeled_cloud::toEigen(T_robot_sensor));
  const auto& classes = observation.cloud.classes;
  const auto unlabeled = std::count(classes.begin(), classes.end(), kNoClass);
  writeScan(observation, observation.cloud.size(), classes.size() - unlabeled);
}

void Output::writeScan(const mrpt::obs::CObservation& observation, std::size_t points,
                       std::size_t labeled) {
  m_writer.write(observation);
  ++m_summary.scans;
  m_summary.points += points;
  m_summary.labeled += labeled;
}

void Output::writeDepth(CObservation3DRangeScan& scan, std::optional<LabelImage> labels) {
  if (!labels) return writeScan(scan, pointsOf(scan), 0);
  if (m_table.size() > kMaxPixelLabels) {
    labeled_cloud::ScanConverter converter(m_table, {}, std::make_shared<OneImage>(*labels));
    return writeCloud(scan.timestamp, scan.sensorLabel, converter.convert(scan)->cloud,
                      scan.sensorPose);
  }
  m_noise.apply(labels->classes);
  setPixelLabels(*labels, m_table, scan);
  const auto counts = labeled_cloud::ScanConverter(m_table).convert(scan)->counts;
  writeScan(scan, counts.points, counts.labeled);
}

Summary Output::finish() {
  if (m_summary.scans == 0)
    throw std::runtime_error(m_conversion.output.string() +
                             ": not written: no scan is there, or no frame was selected");
  m_progress.reset();
  m_writer.finish();
  return m_summary;
}

FrameRange parseFrameRange(const std::string& text) {
  static const std::regex kForm("(\\d{1,9}):(\\d{1,9}):(\\d{1,9})?");
  std::smatch part;
  if (!std::regex_match(text, part, kForm))
    throw std::invalid_argument("--frames " + text +
                                ": expected FIRST:STEP:LAST, for example 0:2:9");
  FrameRange range;
  range.first = std::stoul(part[1]);
  range.step = std::stoul(part[2]);
  if (part[3].matched) range.last = std::stoul(part[3]);
  if (range.step == 0) throw std::invalid_argument("--frames " + text + ": STEP must be 1 or more");
  if (range.last < range.first)
    throw std::invalid_argument("--frames " + text + ": LAST is before FIRST");
  return range;
}

namespace fs = std::filesystem;

namespace {

ClassId classOf(std::uint32_t label, const ClassTable& table) {
  if (!table.empty()) return table.fromRaw(label);
  if (label > static_cast<std::uint32_t>(kMaxClasses))
    throw std::invalid_argument("label " + std::to_string(label) + " is not one of 0..254");
  return static_cast<ClassId>(label);
}

/** As the sensor saw them. */
LabeledCloud cloudOf(const labeled_cloud::PointFile& points, const fs::path& file,
                     const ClassTable& table) {
  LabeledCloud cloud;
  const Eigen::Isometry3d T_sensor_file = points.T_file_sensor.inverse();
  for (const Eigen::Vector3d& p_file : points.points)
    cloud.points.push_back((T_sensor_file * p_file).cast<float>());
  for (const std::uint32_t label : points.labels) try {
      cloud.classes.push_back(classOf(label, table));
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ": point " + std::to_string(cloud.classes.size()) +
                               ": " + e.what());
    }
  return cloud;
}

}  // namespace

Summary convertPointFiles(const std::vector<fs::path>& files, const std::string& labelField,
                          const Conversion& conversion) {
  const ClassTable table = conversion.classes.empty()
                               ? ClassTable()
                               : semantic_types::loadClassTable(conversion.classes);
  Output output(conversion, table);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!output.wants(i, files.size())) continue;
    const auto points = labeled_cloud::readPointFile(files[i], conversion.labels ? labelField : "");
    const auto time = mrpt::Clock::fromDouble(static_cast<double>(i));
    output.writePose(time, labeled_cloud::toMrpt(points.T_file_sensor));
    output.writeCloud(time, "pcd", cloudOf(points, files[i], table));
  }
  return output.finish();
}

}  // namespace dataset2rawlog
