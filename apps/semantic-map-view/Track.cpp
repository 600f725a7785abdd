#include "Track.h"

#include <labeled_cloud/Trajectory.h>
#include <strict_files/OptionList.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace semantic_map_view {

namespace fs = std::filesystem;
using Gear = Track::Gear;

namespace {

std::vector<Track::Point> readTrajectory(const fs::path& file) {
  std::vector<Track::Point> points;
  const auto trajectory = labeled_cloud::loadTumTrajectory(file);
  for (const auto& [time, pose] : trajectory.poses())
    points.push_back({{pose.x(), pose.y(), pose.z()}, Gear::Unknown});
  return points;
}

/** Which fields of a line are what. */
class Columns {
 public:
  explicit Columns(const std::string& header) : m_names(strict_files::csvFieldsOf(header)) {
    for (const char* name : {"x", "y", "z"})
      if (!find(name))
        throw std::runtime_error("expected a CSV file with columns x, y and z, found no column '" +
                                 std::string(name) + "'");
  }

  Track::Point pointOf(const std::string& line) const {
    const auto fields = strict_files::csvFieldsOf(line);
    if (fields.size() != m_names.size())
      throw std::runtime_error("expected " + std::to_string(m_names.size()) + " fields, found " +
                               std::to_string(fields.size()));
    return {{number(fields, "x"), number(fields, "y"), number(fields, "z")}, gearOf(fields)};
  }

 private:
  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = std::find(m_names.begin(), m_names.end(), name);
    if (found == m_names.end()) return {};
    return std::size_t(found - m_names.begin());
  }
  double number(const std::vector<std::string>& fields, const std::string& name) const {
    const std::string& text = fields[*find(name)];
    double value = NAN;
    try {
      value = strict_files::numberOf(text);
    } catch (const std::invalid_argument&) {
    }
    if (!std::isfinite(value))
      throw std::runtime_error(name + " is '" + text + "', expected a number");
    return value;
  }
  Gear gearOf(const std::vector<std::string>& fields) const {
    if (const auto gear = find("gear"))
      return fields[*gear] == "backward" ? Gear::Backward : Gear::Forward;
    if (find("speed")) return number(fields, "speed") < 0 ? Gear::Backward : Gear::Forward;
    return Gear::Unknown;
  }

  std::vector<std::string> m_names;
};

std::vector<Track::Point> readCsv(const fs::path& file) {
  std::istringstream in(strict_files::readText(file));
  std::vector<Track::Point> points;
  std::optional<Columns> columns;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    try {
      if (columns)
        points.push_back(columns->pointOf(line));
      else
        columns.emplace(line);
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(file.string() + ':' + std::to_string(number) + ": " + e.what());
    }
  }
  if (points.empty()) throw std::runtime_error(file.string() + ": no place in this path");
  return points;
}

}  // namespace

double Track::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum += (points[i].place - points[i - 1].place).norm();
  return sum;
}

bool isTrack(const fs::path& file) {
  const auto ending = file.extension();
  return ending == ".tum" || ending == ".txt" || ending == ".csv";
}

Track readTrack(const fs::path& file) {
  return {file.filename().string(),
          file.extension() == ".csv" ? readCsv(file) : readTrajectory(file)};
}

}  // namespace semantic_map_view
