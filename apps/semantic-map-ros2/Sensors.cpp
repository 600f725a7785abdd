#include "Sensors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "point_fields/PointFields.h"

namespace semantic_map_ros2 {

using labeled_cloud::LabelImage;
using mrpt::obs::CObservation3DRangeScan;
using point_fields::cloudOf;
using point_fields::NumberedClasses;
using point_fields::RawCloud;
using ros2::Stamp;
using ros2::textOf;
using semantic_types::ClassTable;
using semantic_types::LabeledCloud;

namespace {

const ros2::Qos kSensor{true, false, 50};
const ros2::Qos kTransforms{true, false, 100}, kStaticTransforms{true, true, 100};
constexpr std::size_t kMostLabelImages = 50;  // that wait for their depth image

RawCloud rawOf(const ros2::PointCloud2& message) {
  RawCloud raw;
  for (std::uint32_t i = 0; i < message.fields._length; ++i) {
    const ros2::PointField& field = message.fields._buffer[i];
    raw.fields.push_back({textOf(field.name), field.offset, field.datatype});
  }
  raw.width = message.width, raw.height = message.height;
  raw.pointStep = message.point_step, raw.rowStep = message.row_step;
  raw.isBigEndian = message.is_bigendian;
  raw.data = message.data._buffer, raw.size = message.data._length;
  return raw;
}

LabeledCloud read(const ros2::LaserScan& message) {
  LabeledCloud cloud;
  for (std::uint32_t i = 0; i < message.ranges._length; ++i) {
    const float range = message.ranges._buffer[i];
    if (!(range >= message.range_min && range <= message.range_max) || !std::isfinite(range))
      continue;
    const float angle = message.angle_min + static_cast<float>(i) * message.angle_increment;
    if (std::isfinite(angle))
      cloud.points.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0f);
  }
  return cloud;
}

/** Pixels of an image as they came; rows may have a rest. */
class Pixels {
 public:
  /** \throw std::runtime_error the data are too short */
  Pixels(const ros2::Image& image, std::size_t bytes) : m_image(image), m_bytes(bytes) {
    const std::uint64_t row = std::uint64_t(image.width) * bytes;
    constexpr std::uint64_t kMost = 40'000'000;
    const bool fits = image.height > 0 && image.width > 0 && image.step >= row &&
                      std::uint64_t(image.width) * image.height <= kMost &&
                      std::uint64_t(image.step) * (image.height - 1) + row <= image.data._length;
    if (!fits)
      throw std::runtime_error(std::to_string(image.data._length) + " bytes are no image of " +
                               std::to_string(image.width) + " x " + std::to_string(image.height) +
                               " pixels of " + std::to_string(bytes) + " bytes");
    const std::uint16_t one = 1;
    std::uint8_t first;
    std::memcpy(&first, &one, 1);
    m_swaps = image.is_bigendian == (first == 1);
  }
  template <class T>
  T at(std::uint32_t row, std::uint32_t column) const {
    std::uint8_t bytes[sizeof(T)];
    std::memcpy(bytes, begin(row, column), sizeof(T));
    if (m_swaps) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }
  const std::uint8_t* begin(std::uint32_t row, std::uint32_t column) const {
    return m_image.data._buffer + std::size_t(row) * m_image.step + column * m_bytes;
  }

 private:
  const ros2::Image& m_image;
  std::size_t m_bytes;
  bool m_swaps;
};

[[noreturn]] void refuseEncoding(const ros2::Image& image, const std::string& expected) {
  throw std::runtime_error("encoding '" + textOf(image.encoding) + "', expected " + expected);
}

/** What a pixel is known by: a raw id, or a color 0xRRGGBB.
 * \throw std::runtime_error it is no label image */
std::function<double(std::uint32_t, std::uint32_t)> numberReader(const ros2::Image& image) {
  const std::string encoding = textOf(image.encoding);
  if (encoding == "mono8" || encoding == "8UC1")
    return [p = Pixels(image, 1)](auto r, auto c) { return *p.begin(r, c); };
  if (encoding == "mono16" || encoding == "16UC1")
    return [p = Pixels(image, 2)](auto r, auto c) { return p.template at<std::uint16_t>(r, c); };
  if (encoding != "rgb8" && encoding != "bgr8")
    refuseEncoding(image, "mono8, mono16, 8UC1, 16UC1 (raw ids), rgb8 or bgr8 (colors)");
  const int red = encoding[0] == 'r' ? 0 : 2;
  return [red, p = Pixels(image, 3)](auto r, auto c) {
    const std::uint8_t* pixel = p.begin(r, c);
    return pixel[red] << 16 | pixel[1] << 8 | pixel[2 - red];
  };
}

LabelImage labelsOf(const ros2::Image& image, const ClassTable& table, std::string& problem) {
  const auto numberAt = numberReader(image);
  NumberedClasses classes(table, textOf(image.encoding).find('g') != std::string::npos);
  LabelImage labels;
  labels.rows = static_cast<int>(image.height), labels.cols = static_cast<int>(image.width);
  labels.classes.reserve(std::size_t(image.width) * image.height);
  for (std::uint32_t row = 0; row < image.height; ++row)
    for (std::uint32_t column = 0; column < image.width; ++column)
      labels.classes.push_back(classes.at(numberAt(row, column)));
  labels.origin = "the label image";
  problem = classes.problem();
  return labels;
}

/** Millimeters, as MRPT's range images have them; 0: no return. */
void setRanges(const ros2::Image& image, CObservation3DRangeScan& scan) {
  const std::string encoding = textOf(image.encoding);
  const bool areMeters = encoding == "32FC1";
  if (!areMeters && encoding != "16UC1" && encoding != "mono16")
    refuseEncoding(image, "16UC1 (mm) or 32FC1 (m)");
  const Pixels pixels(image, areMeters ? 4 : 2);
  const auto rows = static_cast<int>(image.height), cols = static_cast<int>(image.width);
  scan.hasRangeImage = true;
  scan.range_is_depth = true;
  scan.rangeUnits = 0.001f;
  scan.rangeImage_setSize(rows, cols);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) {
      const double mm = areMeters
                            ? std::round(1000.0 * static_cast<double>(pixels.at<float>(row, col)))
                            : pixels.at<std::uint16_t>(row, col);
      scan.rangeImage(row, col) = mm > 0 && mm <= 65535 ? static_cast<std::uint16_t>(mm) : 0;
    }
}

/** \throw std::runtime_error it is of another image, or has no calibration that is known here */
mrpt::img::TCamera cameraOf(const ros2::CameraInfo& info, const ros2::Image& image) {
  if (info.width != image.width || info.height != image.height)
    throw std::runtime_error("the camera's calibration is for " + std::to_string(info.width) +
                             " x " + std::to_string(info.height) + " pixels, the image has " +
                             std::to_string(image.width) + " x " + std::to_string(image.height));
  if (!(info.k[0] > 0) || !(info.k[4] > 0))
    throw std::runtime_error("the camera is not calibrated");
  mrpt::img::TCamera camera;
  camera.ncols = info.width, camera.nrows = info.height;
  camera.setIntrinsicParamsFromValues(info.k[0], info.k[4], info.k[2], info.k[5]);
  const std::string model = textOf(info.distortion_model);
  if (info.d._length == 0) return camera;
  if (model != "plumb_bob" || info.d._length != 5)
    throw std::runtime_error("distortion model '" + model + "', expected plumb_bob of 5 numbers");
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  for (std::size_t i = 0; i < 5; ++i) camera.dist[i] = info.d._buffer[i];
  return camera;
}

/** MRPT's cameras look along x, ROS's optical frames along z. */
Eigen::Isometry3d T_optical_camera() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T;
}

}  // namespace

/** Hands the label image of the depth image that is converted to the converter. */
class Sensors::PixelLabels : public labeled_cloud::ImageLabeler {
 public:
  std::optional<LabelImage> next;
  std::optional<LabelImage> label(const mrpt::obs::CObservation&) override {
    return std::exchange(next, std::nullopt);
  }
};

Stamp NodeClock::now() const {
  using namespace std::chrono;
  if (m_simulated) return m_now;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

Sensors::Sensors(ros2::Node& node, const NodeOptions& options, const ClassTable& classes,
                 const labeled_cloud::ScanConverterOptions& conversion, NodeClock& clock,
                 Transforms& transforms, ScanQueue& queue, Complaints& complaints)
    : m_options(options),
      m_classes(classes),
      m_clock(clock),
      m_transforms(transforms),
      m_queue(queue),
      m_complaints(complaints),
      m_labeler(std::make_shared<PixelLabels>()),
      m_converter(classes, conversion, m_labeler),
      m_hearsClock(node, "/clock", {false, false, 1},
                   [this](auto message) { m_clock.set(ros2::stampOf(message->clock)); }),
      m_hearsTransforms(node, "/tf", kTransforms,
                        [this](auto message) { addTransforms(*message, false); }),
      m_hearsStatic(node, "/tf_static", kStaticTransforms,
                    [this](auto message) { addTransforms(*message, true); }),
      m_hearsOdometry(node, "odom", kSensor,
                      [this](auto message) {
                        const std::string problem = m_transforms.add(*message);
                        if (!problem.empty()) m_complaints.say(problem);
                        const std::lock_guard<std::mutex> lock(m_mutex);
                        m_speeds = {message->twist.twist.linear.x, message->twist.twist.angular.z};
                      }),
      m_hearsPoints(node, "points", kSensor, [this](auto message) { addCloud(message); }),
      m_hearsLaser(node, "scan", kSensor, [this](auto message) { addLaser(message); }),
      m_hearsCamera(node, "depth/camera_info", kSensor,
                    [this](auto message) {
                      const std::lock_guard<std::mutex> lock(m_mutex);
                      m_camera = message;
                    }),
      m_hearsLabels(node, "labels/image", kSensor, [this](auto message) { addLabels(message); }),
      m_hearsDepth(node, "depth/image", kSensor, [this](auto message) { addDepth(message); }) {}

Sensors::~Sensors() = default;

Speeds Sensors::speeds() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_speeds;
}

void Sensors::addTransforms(const ros2::TFMessage& message, bool areStatic) {
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const std::string problem = m_transforms.add(message.transforms._buffer[i], areStatic);
    if (!problem.empty()) m_complaints.say(problem);
  }
  m_queue.wake();
}

void Sensors::add(WaitingScan scan, const ros2::Header& header, std::size_t bytes) {
  scan.frame = textOf(header.frame_id);
  if (!scan.frame.empty() && scan.frame[0] == '/') scan.frame.erase(0, 1);
  scan.stamp = ros2::stampOf(header.stamp);
  scan.cameAt = m_clock.now();
  scan.came = std::chrono::steady_clock::now();
  scan.bytes = bytes;
  const std::string topic = scan.topic;
  if (m_queue.push(std::move(scan)) > 0)
    m_complaints.say(topic + ": scans come faster than they are inserted; the oldest are left out");
}

void Sensors::addCloud(std::shared_ptr<const ros2::PointCloud2> message) {
  WaitingScan scan;
  scan.topic = m_hearsPoints.name();
  scan.read = [this, message] { return read(*message); };
  add(std::move(scan), message->header, message->data._length);
}

void Sensors::addLaser(std::shared_ptr<const ros2::LaserScan> message) {
  WaitingScan scan;
  scan.topic = m_hearsLaser.name();
  scan.read = [message] { return semantic_map_ros2::read(*message); };
  add(std::move(scan), message->header, 4 * std::size_t(message->ranges._length));
}

void Sensors::addDepth(Depth message) {
  WaitingScan scan;
  scan.topic = m_hearsDepth.name();
  scan.T_frame_points = T_optical_camera();
  scan.isComplete = [this, stamp = ros2::stampOf(message->header.stamp)] {
    return hasLabels(stamp);
  };
  scan.read = [this, message] { return read(*message); };
  add(std::move(scan), message->header, message->data._length);
}

void Sensors::addLabels(std::shared_ptr<const ros2::Image> message) {
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_labels[ros2::stampOf(message->header.stamp)] = message;
    while (m_labels.size() > kMostLabelImages) m_labels.erase(m_labels.begin());
  }
  m_queue.wake();
}

bool Sensors::hasLabels(Stamp stamp) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_camera && m_labels.count(stamp) > 0;
}

LabeledCloud Sensors::read(const ros2::PointCloud2& message) {
  std::string problem;
  LabeledCloud cloud = cloudOf(rawOf(message), m_options.classField, m_classes, problem);
  if (!problem.empty()) m_complaints.say(m_hearsPoints.name() + ": " + problem);
  return cloud;
}

LabeledCloud Sensors::read(const ros2::Image& depth) {
  std::shared_ptr<const ros2::CameraInfo> camera;
  std::shared_ptr<const ros2::Image> labels;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    camera = m_camera;
    const auto it = m_labels.find(ros2::stampOf(depth.header.stamp));
    if (it != m_labels.end()) labels = it->second;
    m_labels.erase(m_labels.begin(), m_labels.upper_bound(ros2::stampOf(depth.header.stamp)));
  }
  if (!camera) throw std::runtime_error("no " + m_hearsCamera.name() + " came");
  CObservation3DRangeScan scan;
  scan.cameraParams = cameraOf(*camera, depth);
  setRanges(depth, scan);
  m_labeler->next.reset();
  if (!labels)
    m_complaints.say(m_hearsLabels.name() + ": nothing came with the stamp of a depth image");
  else
    try {
      std::string problem;
      m_labeler->next = labelsOf(*labels, m_classes, problem);
      if (!problem.empty()) m_complaints.say(m_hearsLabels.name() + ": " + problem);
    } catch (const std::exception& e) {
      m_complaints.say(m_hearsLabels.name() + ": points are without classes", e.what());
    }
  return std::move(m_converter.convert(scan)->cloud);
}

}  // namespace semantic_map_ros2
