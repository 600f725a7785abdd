#include "PointFields.h"

#include <labeled_cloud/ScanConverter.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace point_fields {

using labeled_cloud::LabelImage;
using mrpt::obs::CObservation3DRangeScan;
using semantic_types::ClassTable;

namespace {

/** Pixels of an image as they came; rows may have a rest. */
class Pixels {
 public:
  /** \throw std::runtime_error the data are too short */
  Pixels(const RawImage& image, std::size_t bytes) : m_image(image), m_bytes(bytes) {
    const std::uint64_t row = std::uint64_t(image.width) * bytes;
    constexpr std::uint64_t kMost = 40'000'000;
    const bool fits = image.height > 0 && image.width > 0 && image.step >= row &&
                      std::uint64_t(image.width) * image.height <= kMost &&
                      std::uint64_t(image.step) * (image.height - 1) + row <= image.size;
    if (!fits)
      throw std::runtime_error(std::to_string(image.size) + " bytes are no image of " +
                               std::to_string(image.width) + " x " + std::to_string(image.height) +
                               " pixels of " + std::to_string(bytes) + " bytes");
  }
  template <class T>
  T at(std::uint32_t row, std::uint32_t column) const {
    return numberAt<T>(begin(row, column), m_image.isBigEndian);
  }
  const std::uint8_t* begin(std::uint32_t row, std::uint32_t column) const {
    return m_image.data + std::size_t(row) * m_image.step + column * m_bytes;
  }

 private:
  const RawImage& m_image;
  std::size_t m_bytes;
};

[[noreturn]] void refuseEncoding(const RawImage& image, const std::string& expected) {
  throw std::runtime_error("encoding '" + image.encoding + "', expected " + expected);
}

/** What a pixel is known by: a raw id, or a color 0xRRGGBB.
 * \throw std::runtime_error it is no label image */
std::function<double(std::uint32_t, std::uint32_t)> numberReader(const RawImage& image) {
  const std::string& encoding = image.encoding;
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

/** Millimeters, as MRPT's range images have them; 0: no return. */
void setRanges(const RawImage& image, CObservation3DRangeScan& scan) {
  if (!mayBeDepth(image.encoding)) refuseEncoding(image, "16UC1 (mm) or 32FC1 (m)");
  const bool areMeters = image.encoding == "32FC1";
  const Pixels pixels(image, areMeters ? 4 : 2);
  const auto rows = static_cast<int>(image.height), cols = static_cast<int>(image.width);
  scan.hasRangeImage = true;
  scan.range_is_depth = true;
  scan.rangeUnits = 0.001f;
  scan.maxRange = 65.535f;  // nothing says how far the camera sees
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
mrpt::img::TCamera cameraOf(const RawCamera& raw, const RawImage& image) {
  if (raw.width != image.width || raw.height != image.height)
    throw std::runtime_error("the camera's calibration is for " + std::to_string(raw.width) +
                             " x " + std::to_string(raw.height) + " pixels, the image has " +
                             std::to_string(image.width) + " x " + std::to_string(image.height));
  const auto& k = raw.matrix;
  if (!(k[0] > 0) || !(k[4] > 0)) throw std::runtime_error("the camera is not calibrated");
  mrpt::img::TCamera camera;
  camera.ncols = raw.width, camera.nrows = raw.height;
  camera.setIntrinsicParamsFromValues(k[0], k[4], k[2], k[5]);
  if (raw.distortion.empty()) return camera;
  if (raw.model != "plumb_bob" || raw.distortion.size() != 5)
    throw std::runtime_error("distortion model '" + raw.model +
                             "', expected plumb_bob of 5 numbers");
  camera.distortion = mrpt::img::DistortionModel::plumb_bob;
  std::copy(raw.distortion.begin(), raw.distortion.end(), camera.dist.begin());
  return camera;
}

}  // namespace

LabelImage labelsOf(const RawImage& image, const ClassTable& table, std::string& problem) {
  const auto numberAt = numberReader(image);
  NumberedClasses classes(table, image.encoding.find('g') != std::string::npos);
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

bool mayBeDepth(const std::string& encoding) {
  return encoding == "32FC1" || encoding == "16UC1" || encoding == "mono16";
}

CObservation3DRangeScan depthOf(const RawImage& image, const RawCamera& camera) {
  CObservation3DRangeScan scan;
  scan.cameraParams = cameraOf(camera, image);
  setRanges(image, scan);
  return scan;
}

Eigen::Isometry3d T_optical_camera() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T;
}

using semantic_types::ClassId;
using semantic_types::Color;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

namespace {

struct Type {
  std::size_t bytes;
  double (*read)(const std::uint8_t* place, bool isBigEndian);
};

template <class T>
constexpr Type typeOf() {
  return {sizeof(T), [](const std::uint8_t* place, bool isBigEndian) {
            return static_cast<double>(numberAt<T>(place, isBigEndian));
          }};
}

/** By sensor_msgs/PointField's number; 0 is none. */
constexpr std::array<Type, 9> kTypes = {Type{},
                                        typeOf<std::int8_t>(),
                                        typeOf<std::uint8_t>(),
                                        typeOf<std::int16_t>(),
                                        typeOf<std::uint16_t>(),
                                        typeOf<std::int32_t>(),
                                        typeOf<std::uint32_t>(),
                                        typeOf<float>(),
                                        typeOf<double>()};

/** Reads a field of any type, of points of either byte order. */
class FieldReader {
 public:
  FieldReader(const RawCloud& raw, const RawCloud::Field& field)
      : m_offset(field.offset), m_type(field.type), m_swaps(raw.isBigEndian) {
    if (m_type < 1 || m_type > 8)
      throw std::runtime_error("field '" + field.name + "' has the type " + std::to_string(m_type) +
                               ", expected 1 to 8");
    if (m_offset + kTypes[m_type].bytes > raw.pointStep)
      throw std::runtime_error("field '" + field.name + "' lies outside of its point of " +
                               std::to_string(raw.pointStep) + " bytes");
  }

  double number(const std::uint8_t* point) const {
    return kTypes[m_type].read(point + m_offset, m_swaps);
  }
  /** Four bytes 0xAARRGGBB, whose type may be float; what has other types has no color. */
  double color(const std::uint8_t* point) const {
    const bool is = kTypes[m_type].bytes == 4;
    return is ? numberAt<std::uint32_t>(point + m_offset, m_swaps) & 0xffffff : -1;
  }

 private:
  std::size_t m_offset;
  int m_type;
  bool m_swaps;
};

const RawCloud::Field* find(const RawCloud& raw, const std::string& name) {
  for (const RawCloud::Field& field : raw.fields)
    if (field.name == name) return &field;
  return nullptr;
}

FieldReader coordinate(const RawCloud& raw, const std::string& name) {
  const RawCloud::Field* field = find(raw, name);
  if (!field) throw std::runtime_error("the points have no field '" + name + "'");
  return {raw, *field};
}

/** Each point is within the data: rows of points that may have a rest between them. */
void checkSize(const RawCloud& raw) {
  const std::uint64_t row = std::uint64_t(raw.width) * raw.pointStep;
  const bool fits = raw.height == 0 || raw.width == 0 ||
                    ((raw.height == 1 || raw.rowStep >= row) &&
                     std::uint64_t(raw.rowStep) * (raw.height - 1) + row <= raw.size);
  if (!fits)
    throw std::runtime_error(std::to_string(raw.size) + " bytes are no " +
                             std::to_string(raw.width) + " x " + std::to_string(raw.height) +
                             " points of " + std::to_string(raw.pointStep) + " bytes");
}

/** The points that are finite, and their bytes. */
struct FinitePoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<const std::uint8_t*> bytes;

  explicit FinitePoints(const RawCloud& raw) {
    const FieldReader x = coordinate(raw, "x"), y = coordinate(raw, "y"), z = coordinate(raw, "z");
    checkSize(raw);
    const std::uint32_t rows = raw.width > 0 ? raw.height : 0;
    for (std::uint32_t row = 0; row < rows; ++row)
      for (std::uint32_t column = 0; column < raw.width; ++column) {
        const std::uint8_t* point =
            raw.data + std::size_t(row) * raw.rowStep + std::size_t(column) * raw.pointStep;
        const Eigen::Vector3f p =
            Eigen::Vector3d(x.number(point), y.number(point), z.number(point)).cast<float>();
        if (!p.allFinite()) continue;
        points.push_back(p);
        bytes.push_back(point);
      }
  }
};

}  // namespace

std::vector<float> timesOf(const RawCloud& raw, double stamp) {
  const RawCloud::Field* field = nullptr;
  for (const char* name : {"t", "time", "timestamp", "time_stamp", "time_offset", "offset_time"})
    if (!field) field = find(raw, name);
  if (!field) return {};
  const FieldReader reader(raw, *field);
  std::vector<double> numbers;
  for (const std::uint8_t* point : FinitePoints(raw).bytes) numbers.push_back(reader.number(point));
  const double unit = field->type < 7 ? 1e-9 : 1;
  const std::pair<double, double> readings[] = {{unit, 0}, {unit, stamp}, {1e-9, stamp}};
  for (const auto& [seconds, zero] : readings) {
    std::vector<double> afterStamp;
    for (const double n : numbers) afterStamp.push_back(n * seconds - zero);
    const auto times = labeled_cloud::timesOfPoints(afterStamp);
    if (!times.empty()) return times;
  }
  return {};
}

ClassId NumberedClasses::at(double number) {
  if (m_lastClass && number == m_last) return *m_lastClass;
  const auto known = m_known.find(number);
  m_last = number;
  return *(m_lastClass = known != m_known.end() ? known->second : m_known[number] = find(number));
}

ClassId NumberedClasses::find(double number) {
  try {
    const std::uint32_t id = labeled_cloud::rawIdOf(number);
    if (!m_areColors) return labeled_cloud::classOfRawId(id, m_table);
    const Color color{std::uint8_t(id >> 16), std::uint8_t(id >> 8), std::uint8_t(id)};
    const auto found = m_table.find(color);
    if (!found && id != 0)
      throw std::invalid_argument("a color (" + std::to_string(color.r) + ", " +
                                  std::to_string(color.g) + ", " + std::to_string(color.b) +
                                  ") that no class has");
    return found.value_or(kNoClass);
  } catch (const std::invalid_argument& e) {
    if (m_problem.empty()) m_problem = e.what();
    return kNoClass;
  }
}

LabeledCloud cloudOf(const RawCloud& raw, const std::string& classField, const ClassTable& table,
                     std::string& problem) {
  FinitePoints finite(raw);
  LabeledCloud cloud;
  cloud.points = std::move(finite.points);
  const RawCloud::Field* field = find(raw, classField);
  if (!field) {
    problem = "the points have no field '" + classField + "': they are without classes";
    return cloud;
  }
  const bool areColors = field->name == "rgb" || field->name == "rgba";
  const FieldReader reader(raw, *field);
  NumberedClasses classes(table, areColors);
  cloud.classes.reserve(cloud.size());
  for (const std::uint8_t* point : finite.bytes)
    cloud.classes.push_back(classes.at(areColors ? reader.color(point) : reader.number(point)));
  if (!classes.problem().empty())
    problem =
        "field '" + classField + "': " + classes.problem() + ": such points are without classes";
  return cloud;
}

LabeledCloud cloudOf(const RawLaserScan& raw, std::vector<float>& times, bool withEmpty) {
  const bool hasTimes = raw.timeStep > 0 && std::isfinite(raw.timeStep);
  LabeledCloud cloud;
  times.clear();
  for (std::size_t i = 0; i < raw.ranges.size(); ++i) {
    const bool isEmpty = withEmpty && raw.ranges[i] == INFINITY && std::isfinite(raw.mostRange);
    const float range = isEmpty ? 2 * raw.mostRange : raw.ranges[i], step = static_cast<float>(i);
    const float angle = raw.firstAngle + step * raw.angleStep;
    const bool isMet = range >= raw.leastRange && range <= raw.mostRange && std::isfinite(range);
    if (!(isMet || isEmpty) || !std::isfinite(angle)) continue;
    cloud.points.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0f);
    if (hasTimes) times.push_back(step * raw.timeStep);
  }
  return cloud;
}

}  // namespace point_fields
