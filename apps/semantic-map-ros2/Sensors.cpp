#include "Sensors.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "point_fields/PointFields.h"

namespace semantic_map_ros2 {

using labeled_cloud::LabelImage;
using point_fields::cloudOf;
using Kind = point_fields::Frames::Kind;
using point_fields::RawCamera;
using point_fields::RawCloud;
using point_fields::RawImage;
using ros2::textOf;
using semantic_slam::SensorScan;
using semantic_types::ClassTable;

namespace {

const ros2::Qos kSensor{true, false, 50};
const ros2::Qos kTransforms{true, false, 100}, kStaticTransforms{true, true, 100};

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

RawImage rawOf(const ros2::Image& message) {
  return {message.width,
          message.height,
          message.step,
          textOf(message.encoding),
          message.is_bigendian != 0,
          message.data._buffer,
          message.data._length};
}

RawCamera rawOf(const ros2::CameraInfo& message) {
  RawCamera raw{message.width, message.height, textOf(message.distortion_model), {}, {}};
  if (message.d._length > 0)
    raw.distortion.assign(message.d._buffer, message.d._buffer + message.d._length);
  std::copy_n(message.k, raw.matrix.size(), raw.matrix.begin());
  return raw;
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
                 point_fields::Frames& frames, ScanQueue& queue, Complaints& complaints)
    : m_options(options),
      m_classes(classes),
      m_clock(clock),
      m_frames(frames),
      m_queue(queue),
      m_complaints(complaints),
      m_labeler(std::make_shared<PixelLabels>()),
      m_converter(classes, conversion, m_labeler),
      m_hearsClock(node, "/clock", {false, false, 1},
                   [this](auto message) { m_clock.set(ros2::stampOf(message->clock)); }),
      m_hearsTransforms(node, "/tf", kTransforms,
                        [this](auto message) { addTransforms(*message, Kind::Moving); }),
      m_hearsStatic(node, "/tf_static", kStaticTransforms,
                    [this](auto message) { addTransforms(*message, Kind::Static); }),
      m_hearsOdometry(node, "odom", kSensor,
                      [this](auto message) {
                        add(*message, message->pose.pose.position, message->pose.pose.orientation,
                            Kind::Odometers);
                        const std::lock_guard<std::mutex> lock(m_mutex);
                        m_speeds = {message->twist.twist.linear.x, message->twist.twist.angular.z};
                      }),
      m_hearsPoints(node, "points", kSensor,
                    [this](auto message) { add(m_hearsPoints, message, message->data._length); }),
      m_hearsLaser(
          node, "scan", kSensor,
          [this](auto message) { add(m_hearsLaser, message, 4 * message->ranges._length); }),
      m_hearsCamera(node, "depth/camera_info", kSensor,
                    [this](auto message) {
                      const std::lock_guard<std::mutex> lock(m_mutex);
                      m_camera = message;
                    }),
      m_hearsLabels(node, "labels/image", kSensor, [this](auto message) { addLabels(message); }),
      m_hearsDepth(node, "depth/image", kSensor,
                   [this](auto message) { add(m_hearsDepth, message, message->data._length); }) {}

Sensors::~Sensors() = default;

Speeds Sensors::speeds() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_speeds;
}

template <class Message, class Vector, class Rotation>
void Sensors::add(const Message& message, const Vector& t, const Rotation& r, Kind kind) {
  const std::string problem = m_frames.add({ros2::stampOf(message.header.stamp),
                                            textOf(message.header.frame_id),
                                            textOf(message.child_frame_id),
                                            {t.x, t.y, t.z},
                                            {r.w, r.x, r.y, r.z}},
                                           kind);
  if (!problem.empty()) m_complaints.say(problem);
}

void Sensors::addTransforms(const ros2::TFMessage& message, Kind kind) {
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const ros2::TransformStamped& transform = message.transforms._buffer[i];
    add(transform, transform.transform.translation, transform.transform.rotation, kind);
  }
  m_queue.wake();
}

template <class Message>
void Sensors::add(const ros2::Subscription<Message>& from, std::shared_ptr<const Message> message,
                  std::size_t bytes) {
  WaitingScan scan;
  scan.topic = from.name();
  scan.frame = textOf(message->header.frame_id);
  scan.stamp = ros2::stampOf(message->header.stamp);
  scan.bytes = bytes;
  if constexpr (std::is_same_v<Message, ros2::Image>) {
    scan.T_frame_points = point_fields::T_optical_camera();
    scan.isComplete = [this, stamp = scan.stamp] { return hasLabels(stamp); };
  }
  scan.read = [this, message] { return read(*message); };
  m_queue.push(std::move(scan));
}

void Sensors::addLabels(std::shared_ptr<const ros2::Image> message) {
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_labels.add(std::move(message));
  }
  m_queue.wake();
}

bool Sensors::hasLabels(Stamp stamp) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_camera && m_labels.has(stamp);
}

SensorScan Sensors::read(const ros2::PointCloud2& message) {
  std::string problem;
  SensorScan scan;
  scan.cloud = cloudOf(rawOf(message), m_options.classField, m_classes, problem);
  scan.times = timesOf(rawOf(message), ros2::secondsOf(ros2::stampOf(message.header.stamp)));
  if (!problem.empty()) m_complaints.say(m_hearsPoints.name() + ": " + problem);
  return scan;
}

SensorScan Sensors::read(const ros2::LaserScan& message) {
  const point_fields::RawLaserScan raw{
      message.angle_min,
      message.angle_increment,
      message.time_increment,
      message.range_min,
      message.range_max,
      {message.ranges._buffer, message.ranges._buffer + message.ranges._length}};
  SensorScan scan;
  const bool withEmpty = m_converter.options().emptyCarves;
  scan.cloud = cloudOf(raw, scan.times, withEmpty);
  if (withEmpty) scan.emptyFrom = static_cast<double>(raw.mostRange);
  return scan;
}

SensorScan Sensors::read(const ros2::Image& depth) {
  std::shared_ptr<const ros2::CameraInfo> camera;
  std::shared_ptr<const ros2::Image> labels;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    camera = m_camera;
    labels = m_labels.take(ros2::stampOf(depth.header.stamp));
  }
  if (!camera) throw std::runtime_error("no " + m_hearsCamera.name() + " came");
  const auto scan = point_fields::depthOf(rawOf(depth), rawOf(*camera));
  m_labeler->next.reset();
  if (!labels)
    m_complaints.say(m_hearsLabels.name() + ": nothing came with the stamp of a depth image");
  else
    try {
      std::string problem;
      m_labeler->next = point_fields::labelsOf(rawOf(*labels), m_classes, problem);
      if (!problem.empty()) m_complaints.say(m_hearsLabels.name() + ": " + problem);
    } catch (const std::exception& e) {
      m_complaints.say(m_hearsLabels.name() + ": points are without classes", e.what());
    }
  const auto seen = m_converter.convert(scan);
  return {seen->withEmpty(), Eigen::Isometry3d::Identity(), seen->emptyFrom};
}

}  // namespace semantic_map_ros2
