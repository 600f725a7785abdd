#include <semantic_types/ClassTableFile.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include "Conversion.h"
#include "Output.h"

namespace dataset2rawlog {

using strict_files::numberOf;
using strict_files::numbersOf;
using strict_files::readLines;
using strict_files::TextLine;

namespace fs = std::filesystem;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kMaxClasses;
using semantic_types::LabeledCloud;

namespace {

/** What the header of a PCD file says. */
struct PcdHeader {
  /** Columns of x, y, z, label. */
  std::size_t x = 0, y = 0, z = 0, label = 0;
  std::size_t points = 0;
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  /** Index of the first line of data. */
  std::size_t dataBegin = 0;
};

/** Header entries by their first word, up to and with DATA. */
std::map<std::string, TextLine> splitHeader(const fs::path& file,
                                            const std::vector<TextLine>& lines,
                                            std::size_t& dataBegin) {
  std::map<std::string, TextLine> entries;
  for (dataBegin = 0; dataBegin < lines.size() && !entries.count("DATA"); ++dataBegin) {
    const auto& [text, where] = lines[dataBegin];
    const std::size_t space = std::min(text.find(' '), text.size());
    entries[text.substr(0, space)] = {text.substr(space), where};
  }
  for (const char* key : {"FIELDS", "POINTS", "DATA"})
    if (!entries.count(key))
      throw std::runtime_error(file.string() + ": no " + key + " in the PCD header");
  return entries;
}

std::vector<std::string> wordsOf(const TextLine& line) {
  std::istringstream stream(line.text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/** Where each field's column is: a field may have several (COUNT). */
class Columns {
 public:
  Columns(const TextLine& fields, const TextLine* count) : m_where(fields.where) {
    const std::vector<std::string> names = wordsOf(fields);
    std::vector<std::string> counts(names.size(), "1");
    if (count) counts = wordsOf(*count);
    if (counts.size() != names.size())
      throw std::runtime_error(count->where + ": " + std::to_string(counts.size()) +
                               " counts for " + std::to_string(names.size()) + " fields");
    std::size_t next = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double number = numberOf(counts[i], "a count");
      if (!(number >= 1 && number < 1e6))
        throw std::runtime_error(count->where + ": a count of " + counts[i]);
      m_columns[names[i]] = {next, static_cast<std::size_t>(number)};
      next += static_cast<std::size_t>(number);
    }
  }
  std::size_t operator[](const std::string& name) const {
    const auto found = m_columns.find(name);
    if (found == m_columns.end()) throw std::runtime_error(m_where + ": no field '" + name + "'");
    if (found->second.second != 1)
      throw std::runtime_error(m_where + ": field '" + name + "' has several values");
    return found->second.first;
  }

 private:
  std::string m_where;
  std::map<std::string, std::pair<std::size_t, std::size_t>> m_columns;  ///< first, how many
};

/** Missing coordinates are "nan" in PCD files. */
double valueOf(const std::string& word) {
  return word == "nan" || word == "-nan" ? NAN : numberOf(word, "a number");
}

Eigen::Isometry3d viewpoint(const TextLine& line) {
  const auto v = numbersOf(line, 7);
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > 0.01)
    throw std::runtime_error(line.where + ": the quaternion's length is not 1");
  return Eigen::Translation3d(v[0], v[1], v[2]) * q.normalized();
}

std::size_t numberOfPoints(const TextLine& line) {
  const double number = numbersOf(line, 1)[0];
  if (!(number >= 0 && number < 1e12 && number == std::floor(number)))
    throw std::runtime_error(line.where + ": expected a number of points, found '" + line.text +
                             "'");
  return static_cast<std::size_t>(number);
}

PcdHeader readHeader(const fs::path& file, const std::vector<TextLine>& lines) {
  PcdHeader header;
  const auto entries = splitHeader(file, lines, header.dataBegin);
  if (entries.at("DATA").text != " ascii")
    throw std::runtime_error(entries.at("DATA").where + ": expected 'DATA ascii'");
  const auto count = entries.find("COUNT");
  const Columns columns(entries.at("FIELDS"), count == entries.end() ? nullptr : &count->second);
  header.x = columns["x"];
  header.y = columns["y"];
  header.z = columns["z"];
  header.label = columns["label"];
  header.points = numberOfPoints(entries.at("POINTS"));
  const auto view = entries.find("VIEWPOINT");
  if (view != entries.end()) header.T_world_sensor = viewpoint(view->second);
  return header;
}

ClassId classOf(double label, const ClassTable& table) {
  if (!(label >= 0 && label < 4294967296.0 && label == std::floor(label)))
    throw std::invalid_argument("label " + std::to_string(label) + " is no class id");
  const auto raw = static_cast<std::uint32_t>(label);
  if (!table.empty()) return table.fromRaw(raw);
  if (raw > static_cast<std::uint32_t>(kMaxClasses))
    throw std::invalid_argument("label " + std::to_string(raw) + " is not one of 0..254");
  return static_cast<ClassId>(raw);
}

/** Appends the point of one line. Values behind those of the header's fields are left alone. */
void addPoint(const TextLine& line, const PcdHeader& header,
              const Eigen::Isometry3d& T_sensor_world, const ClassTable& table,
              LabeledCloud& cloud) try {
  std::vector<double> v;
  for (const std::string& word : wordsOf(line)) v.push_back(valueOf(word));
  if (v.size() <= std::max({header.x, header.y, header.z, header.label}))
    throw std::invalid_argument("too few values");
  const Eigen::Vector3d p_world(v[header.x], v[header.y], v[header.z]);
  cloud.points.push_back((T_sensor_world * p_world).cast<float>());
  cloud.classes.push_back(classOf(v[header.label], table));
} catch (const std::exception& e) {
  throw std::runtime_error(line.where + ": '" + line.text + "': " + e.what());
}

}  // namespace

Summary convertLabeledPcds(const std::vector<fs::path>& files, const Conversion& conversion) {
  const ClassTable table = conversion.classes.empty()
                               ? ClassTable()
                               : semantic_types::loadClassTable(conversion.classes);
  Output output(conversion, table);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!conversion.wants(i)) continue;
    const auto lines = readLines(files[i]);
    const PcdHeader header = readHeader(files[i], lines);
    if (lines.size() - header.dataBegin != header.points)
      throw std::runtime_error(files[i].string() + ": " +
                               std::to_string(lines.size() - header.dataBegin) +
                               " lines of data for " + std::to_string(header.points) + " points");
    LabeledCloud cloud;
    const Eigen::Isometry3d T_sensor_world = header.T_world_sensor.inverse();
    for (std::size_t k = header.dataBegin; k < lines.size(); ++k)
      addPoint(lines[k], header, T_sensor_world, table, cloud);
    const auto time = mrpt::Clock::fromDouble(static_cast<double>(i));
    const mrpt::math::CMatrixDouble44 pose(header.T_world_sensor.matrix());
    output.writePose(time, mrpt::poses::CPose3D(pose));
    output.writeCloud(time, "pcd", std::move(cloud));
  }
  return output.finish();
}

}  // namespace dataset2rawlog
