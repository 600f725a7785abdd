#include <strict_files/OptionList.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include "PointFields.h"

#ifdef MSO_WITH_LZF
#include <lzf.h>
#endif

namespace labeled_cloud {

using strict_files::numbersOf;
using strict_files::TextLine;

namespace {

/** Header entries by their first word, up to and with DATA. */
using Header = std::map<std::string, TextLine>;

/** Where the data begins: behind the line DATA, or if there is none where a header would be over.
 */
std::size_t dataBeginOf(const std::string& bytes) {
  for (std::size_t line = 0; line < std::min(bytes.size(), kLongestHeader);) {
    const std::size_t end = std::min(bytes.find('\n', line), bytes.size() - 1) + 1;
    if (bytes.compare(line, 5, "DATA ") == 0) return end;
    line = end;
  }
  return std::min(bytes.size(), kLongestHeader);
}

Header headerOf(const std::vector<TextLine>& lines, const std::string& file) {
  Header header;
  for (const auto& [text, where] : lines) {
    const std::size_t space = std::min(text.find(' '), text.size());
    header[text.substr(0, space)] = {text.substr(space), where};
  }
  for (const char* key : {"FIELDS", "POINTS", "DATA"})
    if (!header.count(key)) throw std::runtime_error(file + ": no " + key + " in the PCD header");
  return header;
}

std::vector<std::string> wordsOf(const TextLine& line) {
  std::istringstream stream(line.text);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::size_t wholeOf(const std::string& word, const TextLine& line, double most) {
  const double number = strict_files::numberOf(word);
  if (!(number >= 0 && number <= most && number == std::floor(number)))
    throw std::runtime_error(line.where + ": " + word + ", expected a whole number up to " +
                             strict_files::textOf(most));
  return static_cast<std::size_t>(number);
}

/** The words of an entry that has one for each field. */
std::vector<std::string> wordsForFields(const TextLine& line, const char* what,
                                        std::size_t fields) {
  std::vector<std::string> words = wordsOf(line);
  if (words.size() != fields)
    throw std::runtime_error(line.where + ": " + std::to_string(words.size()) + " " + what +
                             " for " + std::to_string(fields) + " fields");
  return words;
}

std::size_t numberIn(const TextLine& line) {
  return wholeOf(wordsForFields(line, "words", 1)[0], line, 0x1p40);
}

/** Other programs go by WIDTH and HEIGHT. */
void checkGrid(const Header& header, std::size_t points) {
  const auto width = header.find("WIDTH"), height = header.find("HEIGHT");
  if (width == header.end() || height == header.end()) return;
  const std::size_t rows = numberIn(height->second), columns = numberIn(width->second);
  if (rows == 0 ? points != 0 : points % rows != 0 || points / rows != columns)
    throw std::runtime_error(height->second.where + ": a grid of " + std::to_string(columns) +
                             " x " + std::to_string(rows) + " points, and POINTS says " +
                             std::to_string(points));
}

std::vector<PointField> fieldsOf(const Header& header, bool binary) {
  std::vector<PointField> fields;
  for (const std::string& name : wordsOf(header.at("FIELDS"))) fields.push_back({name});
  const auto count = header.find("COUNT");
  if (count != header.end()) {
    const auto counts = wordsForFields(count->second, "counts", fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i)
      fields[i].count = wholeOf(counts[i], count->second, 1e6);
  }
  if (!binary) return fields;
  for (const char* key : {"SIZE", "TYPE"})
    if (!header.count(key))
      throw std::runtime_error(header.at("DATA").where + ": binary data, and no " + key +
                               " in the PCD header");
  const auto sizes = wordsForFields(header.at("SIZE"), "sizes", fields.size());
  const auto types = wordsForFields(header.at("TYPE"), "types", fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i].size = wholeOf(sizes[i], header.at("SIZE"), 8);
    fields[i].kind = types[i][0];
  }
  return fields;
}

Eigen::Isometry3d viewpoint(const TextLine& line) {
  const auto v = numbersOf(line, 7);
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > 0.01)
    throw std::runtime_error(line.where + ": the quaternion's length is not 1");
  return Eigen::Translation3d(v[0], v[1], v[2]) * q.normalized();
}

PointFile readText(const PointFields& fields, const std::string& bytes, std::size_t headerLines) {
  const auto lines = strict_files::linesOf(bytes, fields.file);
  if (lines.size() - headerLines != fields.points)
    throw std::runtime_error(fields.file + ": " + std::to_string(lines.size() - headerLines) +
                             " lines of data for " + std::to_string(fields.points) + " points");
  return readTextPoints(fields, lines, headerLines);
}

void requireBytes(const PointFields& fields, std::size_t bytes) {
  const std::size_t each = bytesOfPoint(fields);
  if (each == 0 || bytes / each != fields.points || bytes % each != 0)
    throw std::runtime_error(fields.file + ": " + std::to_string(bytes) + " bytes of data for " +
                             std::to_string(fields.points) + " points of " + std::to_string(each) +
                             " bytes");
}

/** LZF as in liblzf. \param size bytes of the result \throw std::runtime_error the data is damaged
 * or becomes more or less, its size is none that such data can have, or this was built without
 * liblzf.
 */
std::string decompressLzf(std::string_view data, std::size_t size, const std::string& name) {
#ifdef MSO_WITH_LZF
  constexpr std::size_t kMostPerByte = 88;  // three bytes repeat at most 264
  std::string bytes(size <= data.size() * kMostPerByte ? size : 0, '\0');
  if (bytes.size() != size || lzf_decompress(data.data(), static_cast<unsigned int>(data.size()),
                                             bytes.data(), static_cast<unsigned int>(size)) != size)
    throw std::runtime_error(name + ": " + std::to_string(data.size()) +
                             " bytes of compressed data do not become the " + std::to_string(size) +
                             " that were announced");
  return bytes;
#else
  static_cast<void>(data), static_cast<void>(size);
  throw std::runtime_error(name +
                           ": compressed, and this was built without liblzf; write it as"
                           " DATA binary");
#endif
}

/** Two sizes of 4 bytes, compressed and not; then the fields one after the other, compressed. */
PointFile readCompressed(const PointFields& fields, std::string_view data) {
  std::uint32_t sizes[2] = {};
  if (data.size() >= sizeof sizes) std::memcpy(sizes, data.data(), sizeof sizes);
  if (data.size() < sizeof sizes || sizes[0] > data.size() - sizeof sizes)
    throw std::runtime_error(fields.file + ": " + std::to_string(data.size()) +
                             " bytes of compressed data, announced were " +
                             std::to_string(sizes[0] + sizeof sizes));
  requireBytes(fields, sizes[1]);
  const auto bytes = decompressLzf(data.substr(sizeof sizes, sizes[0]), sizes[1], fields.file);
  return readBinaryPoints(fields, bytes, true);
}

}  // namespace

PointFile parsePcd(const std::string& bytes, const std::string& name, const std::string& label) {
  const std::size_t dataBegin = dataBeginOf(bytes);
  const auto lines = strict_files::linesOf(bytes.substr(0, dataBegin), name);
  const Header header = headerOf(lines, name);
  const std::string format = wordsForFields(header.at("DATA"), "words", 1)[0];
  if (format != "ascii" && format != "binary" && format != "binary_compressed")
    throw std::runtime_error(header.at("DATA").where + ": data '" + format +
                             "', expected ascii, binary or binary_compressed");
  PointFields fields;
  fields.fields = fieldsOf(header, format != "ascii");
  const TextLine& points = header.at("POINTS");
  fields.points = numberIn(points);
  checkGrid(header, fields.points);
  fields.file = name;
  fields.where = header.at("FIELDS").where;
  fields.labelField = label;
  PointFile file;
  const std::string_view data = std::string_view(bytes).substr(dataBegin);
  if (format == "ascii") {
    file = readText(fields, bytes, lines.size());
  } else if (format == "binary") {
    requireBytes(fields, data.size());
    file = readBinaryPoints(fields, data, false);
  } else {
    file = readCompressed(fields, data);
  }
  const auto view = header.find("VIEWPOINT");
  if (view != header.end()) file.T_file_sensor = viewpoint(view->second);
  return file;
}

}  // namespace labeled_cloud
