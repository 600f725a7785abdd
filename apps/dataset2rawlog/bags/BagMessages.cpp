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
  template <class... Numbers>
  void read(Numbers&... numbers) {
    ((numbers = number<Numbers>()), ...);
  }
  std::string text() {
    std::string_view text = m_bytes.bytes(number<std::uint32_t>());
    if (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }
  /** The bytes of an image or a cloud. */
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
  BagLaserScan scan{cdr.header(), {}};
  auto& beams = scan.beams;
  float lastAngle, betweenScans;
  cdr.read(beams.firstAngle, lastAngle, beams.angleStep, beams.timeStep, betweenScans,
           beams.leastRange, beams.mostRange);
  beams.ranges = cdr.numbers<float>();
  return scan;
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

}  // namespace bags
