#include "PointFields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

namespace semantic_map_ros2 {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;
using semantic_types::LabeledCloud;

namespace {

/** Bytes of the types 1 (int8) to 8 (float64). */
constexpr std::array<std::size_t, 9> kSizes = {0, 1, 1, 2, 2, 4, 4, 4, 8};
constexpr int kFloat32 = 7;

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
      case 1: return read<std::int8_t>(point);
      case 2: return read<std::uint8_t>(point);
      case 3: return read<std::int16_t>(point);
      case 4: return read<std::uint16_t>(point);
      case 5: return read<std::int32_t>(point);
      case 6: return read<std::uint32_t>(point);
      case kFloat32: return static_cast<double>(read<float>(point));
      default: return read<double>(point);
    }
  }
  /** Four bytes 0xAARRGGBB, whose type may be float. */
  Color color(const std::uint8_t* point) const {
    if (kSizes[m_type] != 4) return {};
    const auto c = read<std::uint32_t>(point);
    return {std::uint8_t(c >> 16), std::uint8_t(c >> 8), std::uint8_t(c)};
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
    throw std::runtime_error(std::to_string(raw.size) + " bytes are no " + std::to_string(raw.width) +
                             " x " + std::to_string(raw.height) + " points of " +
                             std::to_string(raw.pointStep) + " bytes");
}

/** Classes of points one by one; what many points have in common is looked up once. */
class ClassReader {
 public:
  ClassReader(const RawCloud& raw, const RawCloud::Field& field, const ClassTable& table)
      : m_reader(raw, field), m_table(table), m_isColor(field.name == "rgb" || field.name == "rgba") {
    if (m_isColor && kSizes[field.type] != 4)
      throw std::runtime_error("field '" + field.name + "' has no four bytes");
  }
  /** \throw std::exception a raw id that the table does not know */
  ClassId at(const std::uint8_t* point) {
    const double raw = m_isColor ? keyOf(m_reader.color(point)) : m_reader.number(point);
    if (raw == m_last && m_any) return m_lastClass;
    const auto known = m_known.find(raw);
    const ClassId id = known != m_known.end() ? known->second : m_known[raw] = classOf(raw);
    m_any = true, m_last = raw, m_lastClass = id;
    return id;
  }

 private:
  static double keyOf(Color c) { return c.r * 65536.0 + c.g * 256.0 + c.b; }
  ClassId classOf(double raw) const {
    if (!(raw >= 0 && raw <= 4294967295.0) || raw != std::floor(raw))
      throw std::invalid_argument(std::to_string(raw) + " is no class id");
    const auto id = static_cast<std::uint32_t>(raw);
    if (!m_isColor) return m_table.fromRaw(id);
    return classOfColor({std::uint8_t(id >> 16), std::uint8_t(id >> 8), std::uint8_t(id)}, m_table);
  }

  FieldReader m_reader;
  const ClassTable& m_table;
  bool m_isColor, m_any = false;
  double m_last = 0;
  ClassId m_lastClass = semantic_types::kNoClass;
  std::map<double, ClassId> m_known;
};

}  // namespace

ClassId classOfColor(Color color, const ClassTable& table) {
  return table.find(color).value_or(semantic_types::kNoClass);
}

LabeledCloud cloudOf(const RawCloud& raw, const std::string& classField, const ClassTable& table,
                     std::string& problem) {
  const FieldReader x = coordinate(raw, "x"), y = coordinate(raw, "y"), z = coordinate(raw, "z");
  checkSize(raw);
  LabeledCloud cloud;
  std::vector<const std::uint8_t*> places;
  for (std::uint32_t row = 0; row < raw.height; ++row)
    for (std::uint32_t column = 0; column < raw.width; ++column) {
      const std::uint8_t* point =
          raw.data + std::size_t(row) * raw.rowStep + std::size_t(column) * raw.pointStep;
      const Eigen::Vector3f p = Eigen::Vector3d(x.number(point), y.number(point), z.number(point)).cast<float>();
      if (!p.allFinite()) continue;
      cloud.points.push_back(p);
      places.push_back(point);
    }
  const RawCloud::Field* field = find(raw, classField);
  if (!field) {
    problem = "the points have no field '" + classField + "': they are without classes";
    return cloud;
  }
  try {
    ClassReader classes(raw, *field, table);
    cloud.classes.reserve(places.size());
    for (const std::uint8_t* point : places) cloud.classes.push_back(classes.at(point));
  } catch (const std::exception& e) {
    problem = "field '" + classField + "': " + e.what() + ": the points are without classes";
    cloud.classes.clear();
  }
  return cloud;
}

}  // namespace semantic_map_ros2
