#include "BagMessages.h"

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
  std::string text() {
    std::string_view text = m_bytes.bytes(number<std::uint32_t>());
    if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }
  std::string_view sequenceOfBytes() { return m_bytes.bytes(number<std::uint32_t>()); }
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
  pixels.height = cdr.number<std::uint32_t>();
  pixels.width = cdr.number<std::uint32_t>();
  pixels.encoding = cdr.text();
  pixels.isBigEndian = cdr.number<std::uint8_t>() != 0;
  pixels.step = cdr.number<std::uint32_t>();
  const std::string_view data = cdr.sequenceOfBytes();
  pixels.data = reinterpret_cast<const std::uint8_t*>(data.data());
  pixels.size = data.size();
  return image;
}

point_fields::RawCamera cameraOfMessage(std::string_view message) {
  CdrReader cdr(message);
  cdr.header();
  point_fields::RawCamera camera;
  camera.height = cdr.number<std::uint32_t>();
  camera.width = cdr.number<std::uint32_t>();
  camera.model = cdr.text();
  camera.distortion = cdr.numbers<double>();
  for (double& value : camera.matrix) value = cdr.number<double>();
  return camera;
}

BagLaserScan laserScanOfMessage(std::string_view message) {
  CdrReader cdr(message);
  BagLaserScan scan{cdr.header(), {}};
  auto& beams = scan.beams;
  beams.firstAngle = cdr.number<float>();
  cdr.number<float>();  // last angle
  beams.angleStep = cdr.number<float>();
  beams.timeStep = cdr.number<float>();
  cdr.number<float>();  // between scans
  beams.leastRange = cdr.number<float>();
  beams.mostRange = cdr.number<float>();
  beams.ranges = cdr.numbers<float>();
  return scan;
}

BagCloud cloudOfMessage(std::string_view message) {
  CdrReader cdr(message);
  BagCloud cloud{cdr.header(), {}};
  auto& points = cloud.points;
  points.height = cdr.number<std::uint32_t>();
  points.width = cdr.number<std::uint32_t>();
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
  points.pointStep = cdr.number<std::uint32_t>();
  points.rowStep = cdr.number<std::uint32_t>();
  const std::string_view data = cdr.sequenceOfBytes();
  points.data = reinterpret_cast<const std::uint8_t*>(data.data());
  points.size = data.size();
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

}  // namespace bags
