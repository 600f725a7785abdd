#include "PointFields.h"

#include <strict_files/OptionList.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace labeled_cloud {

namespace {

/** The columns of x, y, z and perhaps the label: indices of fields. */
std::vector<std::size_t> columnsOf(const PointFields& fields) {
  std::vector<std::string> names = {"x", "y", "z"};
  if (!fields.labelField.empty()) names.push_back(fields.labelField);
  std::vector<std::size_t> columns;
  for (const std::string& name : names) {
    const auto found = std::find_if(fields.fields.begin(), fields.fields.end(),
                                    [&](const PointField& f) { return f.name == name; });
    if (found == fields.fields.end()) {
      std::string there;
      for (const PointField& field : fields.fields) there += " '" + field.name + "'";
      throw std::runtime_error(fields.where + ": no field '" + name + "' among" + there);
    }
    if (found->count != 1)
      throw std::runtime_error(fields.where + ": field '" + name + "' has several values");
    columns.push_back(found - fields.fields.begin());
  }
  return columns;
}

/** x, y, z and perhaps the label of a point. */
using Values = std::array<double, 4>;

void addPoint(const Values& values, bool labeled, PointFile& file) {
  file.points.emplace_back(values[0], values[1], values[2]);
  if (!labeled) return;
  const double label = values[3];
  if (!(label >= 0 && label < 4294967296.0 && label == std::floor(label)))
    throw std::invalid_argument("label " + strict_files::textOf(label) + " is no class id");
  file.labels.push_back(static_cast<std::uint32_t>(label));
}

/** Missing coordinates are "nan" in PCD files. */
double valueOf(const std::string& word) {
  return word == "nan" || word == "-nan" ? NAN : strict_files::numberOf(word);
}

std::vector<double> numbersIn(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (std::string word; stream >> word;) numbers.push_back(valueOf(word));
  return numbers;
}

template <typename T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

bool isReadable(const PointField& field) {
  if (field.kind == 'F') return field.size == 4 || field.size == 8;
  return (field.kind == 'I' || field.kind == 'U') &&
         (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
}

double numberAt(const char* bytes, const PointField& field) {
  switch (field.kind) {
    case 'F':
      return field.size == 4 ? as<float>(bytes) : as<double>(bytes);
    case 'I':
      return field.size == 1   ? as<std::int8_t>(bytes)
             : field.size == 2 ? as<std::int16_t>(bytes)
             : field.size == 4 ? as<std::int32_t>(bytes)
                               : as<std::int64_t>(bytes);
    default:
      return field.size == 1   ? as<std::uint8_t>(bytes)
             : field.size == 2 ? as<std::uint16_t>(bytes)
             : field.size == 4 ? as<std::uint32_t>(bytes)
                               : as<std::uint64_t>(bytes);
  }
}

}  // namespace

std::size_t bytesOfPoint(const PointFields& fields) {
  std::size_t bytes = 0;
  for (const PointField& field : fields.fields) bytes += field.size * field.count;
  return bytes;
}

PointFile readTextPoints(const PointFields& fields,
                         const std::vector<strict_files::TextLine>& lines, std::size_t first) {
  std::vector<std::size_t> columns;
  std::size_t needed = 0;
  for (const std::size_t index : columnsOf(fields)) {
    std::size_t column = 0;
    for (std::size_t i = 0; i < index; ++i) column += fields.fields[i].count;
    columns.push_back(column);
    needed = std::max(needed, column + 1);
  }
  PointFile file;
  for (std::size_t i = first; i < first + fields.points; ++i) try {
      const std::vector<double> numbers = numbersIn(lines[i].text);
      if (numbers.size() < needed) throw std::invalid_argument("too few values");
      Values values{};
      for (std::size_t k = 0; k < columns.size(); ++k) values[k] = numbers[columns[k]];
      addPoint(values, columns.size() == 4, file);
    } catch (const std::exception& e) {
      throw std::runtime_error(lines[i].where + ": '" + lines[i].text + "': " + e.what());
    }
  return file;
}

PointFile readBinaryPoints(const PointFields& fields, std::string_view bytes, bool byField) {
  struct Column {
    const PointField* field;
    const char* begin;
    std::size_t stride;
  };
  std::vector<Column> columns;
  for (const std::size_t index : columnsOf(fields)) {
    std::size_t before = 0;
    for (std::size_t i = 0; i < index; ++i)
      before += fields.fields[i].size * fields.fields[i].count;
    const PointField& field = fields.fields[index];
    if (!isReadable(field))
      throw std::runtime_error(fields.where + ": field '" + field.name + "' has type " +
                               field.kind + " and size " + std::to_string(field.size) +
                               ", expected F (4, 8), I or U (1, 2, 4, 8)");
    columns.push_back({&field, bytes.data() + before * (byField ? fields.points : 1),
                       byField ? field.size : bytesOfPoint(fields)});
  }
  PointFile file;
  for (std::size_t i = 0; i < fields.points; ++i) try {
      Values values{};
      for (std::size_t k = 0; k < columns.size(); ++k)
        values[k] = numberAt(columns[k].begin + i * columns[k].stride, *columns[k].field);
      addPoint(values, columns.size() == 4, file);
    } catch (const std::exception& e) {
      throw std::runtime_error(fields.file + ": point " + std::to_string(i) + ": " + e.what());
    }
  return file;
}

PointFile readPointFile(const std::filesystem::path& file, const std::string& labelField) {
  const std::string bytes = strict_files::readText(file);
  const bool ply = bytes.compare(0, 3, "ply") == 0;
  return (ply ? parsePly : parsePcd)(bytes, file.string(), labelField);
}

}  // namespace labeled_cloud
