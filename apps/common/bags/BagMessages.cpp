#include "BagMessages.h"

#include <cmath>

#include "ByteReader.h"

namespace bags {
namespace {

/** Reads what OMG's CDR (version 1, plain) has: numbers are aligned to their size, counted from
 * behind a head of four bytes. */
class CdrReader {
 public:
  explicit CdrReader(std::string_view message) : m_bytes(message) {
    const auto encoding = m_bytes.number<std::uint16_t>(true);
    m_bytes.bytes(2);  // options
    if (encoding > 1)
      throw std::runtime_error("has the encoding " + std::to_string(encoding) +
                               ", expected 0 or 1 (CDR)");
    m_isBigEndian = encoding == 0;
  }

  template <class T>
  T number() {
    constexpr std::size_t kHead = 4;
    const std::size_t beyond = (m_bytes.place() - kHead) % sizeof(T);
    if (beyond > 0) m_bytes.bytes(sizeof(T) - beyond);
    return m_bytes.number<T>(m_isBigEndian);
  }
  template <class... Numbers>
  void read(Numbers&... numbers) {
    ((numbers = number<Numbers>()), ...);
  }
  std::string text() {
    std::string_view text = m_bytes.bytes(number<std::uint32_t>());
    if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }
  /** Those of an image or a cloud. */
  template <class Raw>
  void readBytes(Raw& raw) {
    const std::string_view data = m_bytes.bytes(number<std::uint32_t>());
    raw.data = reinterpret_cast<const std::uint8_t*>(data.data());
    raw.size = data.size();
  }
  /** A number of elements, each of which takes so many bytes at least. */
  std::uint32_t count(std::size_t leastSize) {
    const auto count = number<std::uint32_t>();
    if (count > m_bytes.left() / leastSize)
      throw std::runtime_error("ends too early for " + std::to_string(count) + " elements");
    return count;
  }
  Stamp stamp() {
    const auto seconds = number<std::int32_t>();
    return seconds * Stamp{1000000000} + number<std::uint32_t>();
  }
  BagHeader header() {
    const Stamp at = stamp();
    return {at, text()};
  }
  template <class T>
  std::vector<T> numbers() {
    std::vector<T> numbers(count(sizeof(T)));
    for (T& value : numbers) value = number<T>();
    return numbers;
  }
  Eigen::Vector3d vector() {
    const auto x = number<double>(), y = number<double>();
    return {x, y, number<double>()};
  }
  Eigen::Quaterniond rotation() {
    const Eigen::Vector3d v = vector();
    return {number<double>(), v.x(), v.y(), v.z()};
  }

 private:
  ByteReader m_bytes;
  bool m_isBigEndian = false;
};

FramePose poseOf(CdrReader& cdr) {
  FramePose pose;
  const BagHeader header = cdr.header();
  pose.stamp = header.stamp;
  pose.parent = header.frame;
  pose.child = cdr.text();
  pose.translation = cdr.vector();
  pose.rotation = cdr.rotation();
  return pose;
}

}  // namespace

BagHeader headerOfMessage(std::string_view message) { return CdrReader(message).header(); }

BagImage imageOfMessage(std::string_view message) {
  CdrReader cdr(message);
  BagImage image{cdr.header(), {}};
  auto& pixels = image.pixels;
  cdr.read(pixels.height, pixels.width);
  pixels.encoding = cdr.text();
  pixels.isBigEndian = cdr.number<std::uint8_t>() != 0;
  cdr.read(pixels.step);
  cdr.readBytes(pixels);
  return image;
}

point_fields::RawCamera cameraOfMessage(std::string_view message) {
  CdrReader cdr(message);
  cdr.header();
  point_fields::RawCamera camera;
  cdr.read(camera.height, camera.width);
  camera.model = cdr.text();
  camera.distortion = cdr.numbers<double>();
  for (double& value : camera.matrix) cdr.read(value);
  return camera;
}

BagLaserScan laserScanOfMessage(std::string_view message) {
  CdrReader cdr(message);
  BagHeader header = cdr.header();
  float first, last, step, between, whole, least, most;
  cdr.read(first, last, step, between, whole, least, most);
  return {std::move(header), first, step, least, most, cdr.numbers<float>()};
}

BagCloud cloudOfMessage(std::string_view message) {
  CdrReader cdr(message);
  BagCloud cloud{cdr.header(), {}};
  auto& points = cloud.points;
  cdr.read(points.height, points.width);
  constexpr std::size_t kLeastField = 13;
  for (std::uint32_t left = cdr.count(kLeastField); left > 0; --left) {
    point_fields::RawCloud::Field field;
    field.name = cdr.text();
    field.offset = cdr.number<std::uint32_t>();
    field.type = cdr.number<std::uint8_t>();
    cdr.number<std::uint32_t>();  // of values
    points.fields.push_back(field);
  }
  points.isBigEndian = cdr.number<std::uint8_t>() != 0;
  cdr.read(points.pointStep, points.rowStep);
  cdr.readBytes(points);
  return cloud;
}

std::vector<FramePose> transformsOfMessage(std::string_view message) {
  CdrReader cdr(message);
  std::vector<FramePose> transforms;
  constexpr std::size_t kLeastTransform = 72;
  for (std::uint32_t left = cdr.count(kLeastTransform); left > 0; --left)
    transforms.push_back(poseOf(cdr));
  return transforms;
}

FramePose odometryOfMessage(std::string_view message) {
  CdrReader cdr(message);
  return poseOf(cdr);
}

using Eigen::Isometry3d;

namespace {

/** Old names of frames begin with a slash. */
std::string withoutSlash(const std::string& name) {
  return !name.empty() && name.front() == '/' ? name.substr(1) : name;
}

}  // namespace

void BagFrames::add(const FramePose& pose, bool isStatic) { add(pose, isStatic, false); }
void BagFrames::addOdometry(const FramePose& pose) { add(pose, false, true); }

void BagFrames::add(const FramePose& pose, bool isStatic, bool isOdometers) {
  constexpr double kOff = 0.1;
  if (!pose.translation.allFinite() || !(std::abs(pose.rotation.norm() - 1) < kOff)) return;
  const std::string parent = withoutSlash(pose.parent), child = withoutSlash(pose.child);
  if (parent.empty() || child.empty()) return;
  for (std::string above = parent;; above = m_frames.at(above).parent) {
    if (above == child) return;
    if (m_frames.count(above) == 0) break;
  }
  const auto [it, isNew] = m_frames.try_emplace(child, Frame{parent, isStatic, isOdometers, {}});
  Frame& frame = it->second;
  if (isOdometers != frame.isOdometers || parent != frame.parent) return;
  frame.poses[pose.stamp] =
      Eigen::Translation3d(pose.translation) * Isometry3d(pose.rotation.normalized());
}

std::string BagFrames::robotOf(const std::string& sensor) const {
  std::string frame = withoutSlash(sensor);
  for (auto it = m_frames.find(frame); it != m_frames.end(); it = m_frames.find(frame)) {
    if (!it->second.isStatic) return frame;
    frame = it->second.parent;
  }
  return {};
}

std::optional<Isometry3d> BagFrames::at(const Frame& frame, Stamp stamp) const {
  if (frame.isStatic) return frame.poses.rbegin()->second;
  const auto after = frame.poses.lower_bound(stamp);
  if (after == frame.poses.end()) return std::nullopt;
  if (after->first == stamp) return after->second;
  if (after == frame.poses.begin()) return std::nullopt;
  const auto& [begin, a] = *std::prev(after);
  const auto& [end, b] = *after;
  const double share = static_cast<double>(stamp - begin) / static_cast<double>(end - begin);
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  const Eigen::Vector3d t = a.translation() + share * (b.translation() - a.translation());
  return Eigen::Translation3d(t) * Isometry3d(qa.slerp(share, qb));
}

std::optional<Isometry3d> BagFrames::find(const std::string& name, Stamp stamp,
                                          const std::string& above) const {
  Isometry3d T = Isometry3d::Identity();
  std::string frame = withoutSlash(name);
  for (auto it = m_frames.find(frame); it != m_frames.end() && frame != above;
       it = m_frames.find(frame)) {
    const auto T_parent_frame = at(it->second, stamp);
    if (!T_parent_frame) return std::nullopt;
    T = *T_parent_frame * T;
    frame = it->second.parent;
  }
  return T;
}

}  // namespace bags
