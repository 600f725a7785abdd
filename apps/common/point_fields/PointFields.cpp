#include "PointFields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace point_fields {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::kNoClass;
using semantic_types::LabeledCloud;

namespace {

/** Bytes of the types 1 (int8) to 8 (float64). */
constexpr std::array<std::size_t, 9> kSizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};

/** Reads a field of any type, of points of either byte order. */
class FieldReader {
 public:
  FieldReader(const RawCloud& raw, const RawCloud::Field& field)
      : m_offset(field.offset), m_type(field.type), m_swaps(raw.isBigEndian) {
    if (m_type < 1 || m_type > 8)
      throw std::runtime_error("field '" + field.name + "' has the type " + std::to_string(m_type) +
                               ", expected 1 to 8");
    if (m_offset + kSizes[m_type] > raw.pointStep)
      throw std::runtime_error("field '" + field.name + "' lies outside of its point of " +
                               std::to_string(raw.pointStep) + " bytes");
  }

  double number(const std::uint8_t* point) const {
    switch (m_type) {
      case 1:
        return read<std::int8_t>(point);
      case 2:
        return read<std::uint8_t>(point);
      case 3:
        return read<std::int16_t>(point);
      case 4:
        return read<std::uint16_t>(point);
      case 5:
        return read<std::int32_t>(point);
      case 6:
        return read<std::uint32_t>(point);
      case 7:
        return static_cast<double>(read<float>(point));
      default:
        return read<double>(point);
    }
  }
  /** Four bytes 0xAARRGGBB, whose type may be float; what has other types has no color. */
  double color(const std::uint8_t* point) const {
    return kSizes[m_type] == 4 ? read<std::uint32_t>(point) & 0xffffff : -1;
  }

 private:
  template <class T>
  T read(const std::uint8_t* point) const {
    std::array<std::uint8_t, sizeof(T)> bytes;
    std::memcpy(bytes.data(), point + m_offset, sizeof(T));
    if (m_swaps) std::reverse(bytes.begin(), bytes.end());
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

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
  constexpr double kLongest = 1;  // s between a point and its scan's stamp
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
    std::vector<float> times;
    for (const double n : numbers)
      if (std::abs(n * seconds - zero) <= kLongest)
        times.push_back(static_cast<float>(n * seconds - zero));
    if (times.size() == numbers.size()) return times;
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
  if (number == 0 && !m_areColors && m_table.folds().count(0) == 0) return kNoClass;
  try {
    if (!(number >= 0 && number <= 4294967295.0) || number != std::floor(number))
      throw std::invalid_argument("a number that is no raw id");
    const auto id = static_cast<std::uint32_t>(number);
    if (!m_areColors) return m_table.fromRaw(id);
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

LabeledCloud cloudOf(const RawLaserScan& raw, std::vector<float>& times) {
  const bool hasTimes = raw.timeStep > 0 && std::isfinite(raw.timeStep);
  LabeledCloud cloud;
  times.clear();
  for (std::size_t i = 0; i < raw.ranges.size(); ++i) {
    const float range = raw.ranges[i], step = static_cast<float>(i);
    const float angle = raw.firstAngle + step * raw.angleStep;
    const bool isMet = range >= raw.leastRange && range <= raw.mostRange && std::isfinite(range);
    if (!isMet || !std::isfinite(angle)) continue;
    cloud.points.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0f);
    if (hasTimes) times.push_back(step * raw.timeStep);
  }
  return cloud;
}

}  // namespace point_fields
