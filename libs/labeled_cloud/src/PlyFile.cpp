#include <strict_files/OptionList.h>

#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "PointFields.h"

namespace labeled_cloud {

using strict_files::TextLine;

namespace {

/** Kind and size of a property's type, by its name. */
const std::map<std::string, std::pair<char, std::size_t>> kTypes = {
    {"char", {'I', 1}},  {"int8", {'I', 1}},    {"uchar", {'U', 1}},  {"uint8", {'U', 1}},
    {"short", {'I', 2}}, {"int16", {'I', 2}},   {"ushort", {'U', 2}}, {"uint16", {'U', 2}},
    {"int", {'I', 4}},   {"int32", {'I', 4}},   {"uint", {'U', 4}},   {"uint32", {'U', 4}},
    {"float", {'F', 4}}, {"float32", {'F', 4}}, {"double", {'F', 8}}, {"float64", {'F', 8}}};

std::size_t dataBeginOf(const std::string& bytes, const std::string& file) {
  const std::size_t end = bytes.substr(0, kLongestHeader).find("\nend_header");
  const std::size_t line = end == std::string::npos ? end : bytes.find('\n', end + 1);
  if (line == std::string::npos) throw std::runtime_error(file + ": no end_header in a PLY file");
  return line + 1;
}

/** What the lines of a header say, one after the other. */
class PlyHeader {
 public:
  PlyHeader(const std::vector<TextLine>& lines, const std::string& file) {
    m_fields.file = file;
    for (const TextLine& line : lines) {
      std::istringstream stream(line.text);
      const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
      if (words.empty()) continue;
      if (words[0] == "format")
        m_format = words.size() > 1 ? words[1] : "";
      else if (words[0] == "element")
        addElement(words, line);
      else if (words[0] == "property" && m_elements == 1)
        addProperty(words, line);
    }
    if (m_elements == 0) throw std::runtime_error(file + ": no element vertex in the PLY header");
  }
  const PointFields& fields() const { return m_fields; }
  const std::string& format() const { return m_format; }

 private:
  void addElement(const std::vector<std::string>& words, const TextLine& line) {
    if (++m_elements > 1) return;
    if (words.size() != 3 || words[1] != "vertex")
      throw std::runtime_error(line.where + ": '" + line.text +
                               "', expected the first element to be 'vertex' and its number");
    const double points = strict_files::numberOf(words[2]);
    if (!(points >= 0 && points <= 0x1p40 && points == std::floor(points)))
      throw std::runtime_error(line.where + ": " + words[2] + " points");
    m_fields.points = static_cast<std::size_t>(points);
    m_fields.where = line.where;
  }
  void addProperty(const std::vector<std::string>& words, const TextLine& line) {
    const auto type = words.size() == 3 ? kTypes.find(words[1]) : kTypes.end();
    if (type == kTypes.end())
      throw std::runtime_error(line.where + ": '" + line.text +
                               "', expected a number's type and a name");
    m_fields.fields.push_back({words[2], type->second.first, type->second.second});
  }

  PointFields m_fields;
  std::string m_format;
  int m_elements = 0;
};

}  // namespace

PointFile parsePly(const std::string& bytes, const std::string& name, const std::string& label) {
  const std::size_t dataBegin = dataBeginOf(bytes, name);
  const auto headerLines = strict_files::linesOf(bytes.substr(0, dataBegin), name);
  const PlyHeader header(headerLines, name);
  PointFields fields = header.fields();
  fields.labelField = label;
  const auto requireEnough = [&](std::size_t there, const std::string& what) {
    if (there < fields.points)
      throw std::runtime_error(name + ": " + std::to_string(there) + what + " for " +
                               std::to_string(fields.points) + " points");
  };
  if (header.format() == "ascii") {
    const auto lines = strict_files::linesOf(bytes, name);
    requireEnough(lines.size() - headerLines.size(), " lines of data");
    return readTextPoints(fields, lines, headerLines.size());
  }
  if (header.format() != "binary_little_endian")
    throw std::runtime_error(name + ": format '" + header.format() +
                             "', expected ascii or binary_little_endian");
  const std::size_t each = bytesOfPoint(fields);
  const std::string_view data = std::string_view(bytes).substr(dataBegin);
  requireEnough(each == 0 ? 0 : data.size() / each,
                " times " + std::to_string(each) + " bytes of data");
  return readBinaryPoints(fields, data, false);
}

}  // namespace labeled_cloud
