#include <labeled_cloud/PointFile.h>

#include <labeled_cloud/ScanConverter.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace labeled_cloud {

using strict_files::numbersOf;
using strict_files::TextLine;

namespace {

constexpr std::size_t kLongestHeader = 1 << 16;  ///< bytes that are searched for its end

/** A column of a file of points, or several of one name. */
struct PointField {
  std::string name;
  char kind = 'F';       ///< 'F' floating point, 'I' signed, 'U' unsigned
  std::size_t size = 4;  ///< bytes of a value
  std::size_t count = 1;
};

/** What a header says of the points behind it. */
struct PointHeader {
  std::vector<PointField> fields;
  std::size_t points = 0;
  std::string file, where;  ///< of the list of fields, for messages
  std::size_t lines = 0;    ///< of the header
};

std::vector<std::string> wordsOf(const TextLine& line) {
  std::istringstream stream(line.text);
  return {std::istream_iterator<std::string>(stream), {}};
}

bool isWhole(double number, double most) {
  return number >= 0 && number <= most && number == std::floor(number);
}

constexpr double kMostPoints = 0x1p40;

/** PCD's entries by their first word, up to and with DATA. */
class PcdEntries {
 public:
  PcdEntries(const std::vector<TextLine>& lines, const std::string& file) {
    for (const auto& [text, where] : lines) {
      const std::size_t space = std::min(text.find(' '), text.size());
      m_entries[text.substr(0, space)] = {text.substr(space), where};
    }
    require({"FIELDS", "POINTS", "DATA"}, file + ": no ");
  }
  void require(const std::vector<const char*>& keys, const std::string& before) const {
    for (const char* key : keys)
      if (!find(key)) throw std::runtime_error(before + key + " in the PCD header");
  }
  const TextLine* find(const std::string& key) const {
    const auto found = m_entries.find(key);
    return found == m_entries.end() ? nullptr : &found->second;
  }
  const TextLine& at(const std::string& key) const { return m_entries.at(key); }
  /** The words of an entry that has one for each field. */
  std::vector<std::string> wordsForFields(const std::string& key, const char* what,
                                          std::size_t fields) const {
    std::vector<std::string> words = wordsOf(at(key));
    if (words.size() != fields)
      throw std::runtime_error(at(key).where + ": " + std::to_string(words.size()) + " " + what +
                               " for " + std::to_string(fields) + " fields");
    return words;
  }
  std::vector<std::size_t> wholesForFields(const std::string& key, const char* what,
                                           std::size_t fields, double most) const {
    std::vector<std::size_t> numbers;
    for (const std::string& word : wordsForFields(key, what, fields)) {
      const double number = strict_files::numbersOf({word, at(key).where}, 1)[0];
      if (!isWhole(number, most))
        throw std::runtime_error(at(key).where + ": " + word + ", expected a whole number up to " +
                                 strict_files::textOf(most));
      numbers.push_back(static_cast<std::size_t>(number));
    }
    return numbers;
  }
  std::size_t number(const std::string& key) const {
    return wholesForFields(key, "words", 1, kMostPoints)[0];
  }

 private:
  std::map<std::string, TextLine> m_entries;
};

/** Where the data begins: behind the line DATA, or if there is none where a header would be over.
 */
std::size_t endOfPcdHeader(const std::string& bytes) {
  for (std::size_t line = 0; line < std::min(bytes.size(), kLongestHeader);) {
    const std::size_t end = std::min(bytes.find('\n', line), bytes.size() - 1) + 1;
    if (bytes.compare(line, 5, "DATA ") == 0) return end;
    line = end;
  }
  return std::min(bytes.size(), kLongestHeader);
}

/** Other programs go by WIDTH and HEIGHT. */
void checkGrid(const PcdEntries& entries, std::size_t points) {
  if (!entries.find("WIDTH") || !entries.find("HEIGHT")) return;
  const std::size_t rows = entries.number("HEIGHT"), columns = entries.number("WIDTH");
  if (rows == 0 ? points != 0 : points % rows != 0 || points / rows != columns)
    throw std::runtime_error(entries.at("HEIGHT").where + ": a grid of " + std::to_string(columns) +
                             " x " + std::to_string(rows) + " points, and POINTS says " +
                             std::to_string(points));
}

std::vector<PointField> fieldsOf(const PcdEntries& entries, bool binary) {
  std::vector<PointField> fields;
  for (const std::string& name : wordsOf(entries.at("FIELDS"))) fields.push_back({name});
  const std::size_t n = fields.size();
  if (entries.find("COUNT")) {
    const auto counts = entries.wholesForFields("COUNT", "counts", n, 1e6);
    for (std::size_t i = 0; i < n; ++i) fields[i].count = counts[i];
  }
  if (!binary) return fields;
  entries.require({"SIZE", "TYPE"}, entries.at("DATA").where + ": binary data, and no ");
  const auto sizes = entries.wholesForFields("SIZE", "sizes", n, 8);
  const auto types = entries.wordsForFields("TYPE", "types", n);
  for (std::size_t i = 0; i < n; ++i) fields[i].size = sizes[i], fields[i].kind = types[i][0];
  return fields;
}

Eigen::Isometry3d viewpoint(const TextLine& line) {
  const auto v = numbersOf(line, 7);
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > 0.01)
    throw std::runtime_error(line.where + ": the quaternion's length is not 1");
  return Eigen::Translation3d(v[0], v[1], v[2]) * q.normalized();
}

/** x, y, z or the label in the data, and how many bytes (or numbers of a text) of a point are
 * before it. */
struct Column {
  const PointField* field;
  std::size_t before;
};

std::vector<Column> columnsOf(const PointHeader& header, const std::string& label, bool isText) {
  std::vector<std::string> names = {"x", "y", "z"};
  if (!label.empty()) names.push_back(label);
  std::vector<Column> columns;
  for (const std::string& name : names) {
    std::size_t before = 0;
    auto field = header.fields.begin();
    for (; field != header.fields.end() && field->name != name; ++field)
      before += field->count * (isText ? 1 : field->size);
    if (field == header.fields.end()) {
      std::string there;
      for (const PointField& each : header.fields) there += " '" + each.name + "'";
      throw std::runtime_error(header.where + ": no field '" + name + "' among" + there);
    }
    if (field->count != 1)
      throw std::runtime_error(header.where + ": field '" + name + "' has several values");
    columns.push_back({&*field, before});
  }
  return columns;
}

/** x, y, z and perhaps the label of a point. */
using Values = std::array<double, 4>;

void addPoint(const Values& values, bool labeled, PointFile& file) {
  file.points.emplace_back(values[0], values[1], values[2]);
  if (labeled) file.labels.push_back(rawIdOf(values[3]));
}

/** Missing coordinates are "nan" in PCD files. */
std::vector<double> numbersIn(const TextLine& line) {
  std::vector<double> numbers;
  for (const std::string& word : wordsOf(line))
    numbers.push_back(word == "nan" || word == "-nan" ? NAN : strict_files::numberOf(word));
  return numbers;
}

/** A line of numbers for each point. Values behind those of the fields are left alone. */
PointFile readText(const PointHeader& header, const std::string& label,
                   const std::vector<TextLine>& lines) {
  const std::vector<Column> columns = columnsOf(header, label, true);
  std::size_t needed = 0;
  for (const Column& column : columns) needed = std::max(needed, column.before + 1);
  PointFile file;
  for (std::size_t i = header.lines; i < header.lines + header.points; ++i) try {
      const std::vector<double> numbers = numbersIn(lines[i]);
      if (numbers.size() < needed) throw std::invalid_argument("too few values");
      Values values{};
      for (std::size_t k = 0; k < columns.size(); ++k) values[k] = numbers[columns[k].before];
      addPoint(values, columns.size() == 4, file);
    } catch (const std::exception& e) {
      throw std::runtime_error(lines[i].where + ": '" + lines[i].text + "': " + e.what());
    }
  return file;
}

template <typename T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

using ReadNumber = double (*)(const char*);

/** How numbers of a field are read. \throw std::runtime_error its type is none. */
ReadNumber readerOf(const PointField& field, const std::string& where) {
  static const std::map<std::pair<char, std::size_t>, ReadNumber> readers = {
      {{'F', 4}, as<float>},         {{'F', 8}, as<double>},        {{'I', 1}, as<std::int8_t>},
      {{'I', 2}, as<std::int16_t>},  {{'I', 4}, as<std::int32_t>},  {{'I', 8}, as<std::int64_t>},
      {{'U', 1}, as<std::uint8_t>},  {{'U', 2}, as<std::uint16_t>}, {{'U', 4}, as<std::uint32_t>},
      {{'U', 8}, as<std::uint64_t>},
  };
  const auto found = readers.find({field.kind, field.size});
  if (found != readers.end()) return found->second;
  throw std::runtime_error(where + ": field '" + field.name + "' has type " + field.kind +
                           " and size " + std::to_string(field.size) +
                           ", expected F (4, 8), I or U (1, 2, 4, 8)");
}

std::size_t bytesOfPoint(const PointHeader& header) {
  std::size_t bytes = 0;
  for (const PointField& field : header.fields) bytes += field.size * field.count;
  return bytes;
}

/** Little-endian numbers: all of a point, then all of the next.
 * \param bytes at least as many as the points need */
PointFile readBinary(const PointHeader& header, const std::string& label, std::string_view bytes) {
  const std::vector<Column> columns = columnsOf(header, label, false);
  std::vector<ReadNumber> readers;
  for (const Column& column : columns) readers.push_back(readerOf(*column.field, header.where));
  const std::size_t each = bytesOfPoint(header);
  PointFile file;
  for (std::size_t i = 0; i < header.points; ++i) try {
      Values values{};
      for (std::size_t k = 0; k < columns.size(); ++k)
        values[k] = readers[k](bytes.data() + i * each + columns[k].before);
      addPoint(values, columns.size() == 4, file);
    } catch (const std::exception& e) {
      throw std::runtime_error(header.file + ": point " + std::to_string(i) + ": " + e.what());
    }
  return file;
}

void requireBytes(const PointHeader& header, std::size_t bytes) {
  const std::size_t each = bytesOfPoint(header);
  if (each == 0 || bytes / each != header.points || bytes % each != 0)
    throw std::runtime_error(header.file + ": " + std::to_string(bytes) + " bytes of data for " +
                             std::to_string(header.points) + " points of " + std::to_string(each) +
                             " bytes");
}

PointFile parsePcd(const std::string& bytes, const std::string& name, const std::string& label) {
  const std::size_t dataBegin = endOfPcdHeader(bytes);
  const auto headerLines = strict_files::linesOf(bytes.substr(0, dataBegin), name);
  const PcdEntries entries(headerLines, name);
  const std::string format = entries.wordsForFields("DATA", "words", 1)[0];
  if (format != "ascii" && format != "binary")
    throw std::runtime_error(entries.at("DATA").where + ": data '" + format +
                             "', expected ascii or binary");
  PointHeader header{fieldsOf(entries, format != "ascii"), entries.number("POINTS"), name,
                     entries.at("FIELDS").where, headerLines.size()};
  checkGrid(entries, header.points);
  PointFile file;
  const std::string_view data = std::string_view(bytes).substr(dataBegin);
  if (format == "ascii") {
    const auto lines = strict_files::linesOf(bytes, name);
    if (lines.size() - header.lines != header.points)
      throw std::runtime_error(name + ": " + std::to_string(lines.size() - header.lines) +
                               " lines of data for " + std::to_string(header.points) + " points");
    file = readText(header, label, lines);
  } else {
    requireBytes(header, data.size());
    file = readBinary(header, label, data);
  }
  if (const TextLine* view = entries.find("VIEWPOINT")) file.T_file_sensor = viewpoint(*view);
  return file;
}

}  // namespace

PointFile readPointFile(const std::filesystem::path& file, const std::string& labelField) {
  return parsePcd(strict_files::readText(file), file.string(), labelField);
}

}  // namespace labeled_cloud
