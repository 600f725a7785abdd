#include <strict_files/StrictYaml.h>
#include <strict_files/Words.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace strict_files {

namespace {

/** Counted from 1; 0: there is none. (YAML::LoadAll() may never come back from damaged files.) */
int lineOfSecondDocument(const std::string& text) {
  std::istringstream stream(text);
  bool hasContent = false;
  int number = 0;
  for (std::string line; ++number, std::getline(stream, line);) {
    const bool isMark =
        line.compare(0, 3, "---") == 0 && (line.size() == 3 || line.find_first_of(" \t\r") == 3);
    if (isMark && hasContent) return number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    const bool isBlank = first == std::string::npos || line[first] == '#' || line[0] == '%';
    hasContent |= isMark || !isBlank;
  }
  return 0;
}

/** As numberOf(); yaml-cpp reads numbers as the program's global locale has them. */
bool decode(const YAML::Node& node, double& value) {
  try {
    if (node.IsScalar()) value = numberOf(node.Scalar());
    return node.IsScalar();
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

StrictYaml::StrictYaml(const std::filesystem::path& file) : m_file(file.string()) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    fail(YAML::Mark::null_mark(), "cannot be read");
  parse({std::istreambuf_iterator<char>(stream), {}});
}

StrictYaml::StrictYaml(const std::string& text, const std::string& name) : m_file(name) {
  parse(text);
}

void StrictYaml::parse(const std::string& text) {
  try {
    m_root = YAML::Load(text);
    if (const int line = lineOfSecondDocument(text))
      throw std::runtime_error(m_file + ":" + std::to_string(line) +
                               ": a second document, expected one");
  } catch (const YAML::Exception& e) {
    fail(e.mark, e.msg);
  }
}

void StrictYaml::fail(const YAML::Mark& where, const std::string& what) const {
  const std::string line = where.is_null() ? "" : ":" + std::to_string(where.line + 1);
  throw std::runtime_error(m_file + line + ": " + what);
}

void StrictYaml::fail(const YAML::Node& where, const std::string& what) const {
  fail(where.Mark(), what);
}

void StrictYaml::checkMap(const YAML::Node& map) const {
  if (!map.IsMap()) fail(map, "expected 'key: value' entries");
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = text(entry.first, "a key");
    if (!seen.insert(key).second) fail(entry.first, "key '" + key + "' twice");
  }
}

void StrictYaml::checkKeys(const YAML::Node& map, const std::set<std::string>& known) const {
  checkMap(map);
  for (const auto& entry : map) {
    const std::string key = entry.first.Scalar();
    if (!known.count(key)) fail(entry.first, unknownWord("key", key, {known.begin(), known.end()}));
  }
}

void StrictYaml::read(const YAML::Node& map, const OptionList& list) const {
  for (const auto& entry : map) {
    const Option* option = list.find(entry.first.Scalar());
    if (!option) continue;
    std::vector<std::string> words;
    if (entry.second.IsSequence())
      for (const auto& word : entry.second) words.push_back(text(word, option->name));
    else
      words.push_back(text(entry.second, option->name));
    try {
      option->set(joined(words));
    } catch (const std::invalid_argument& e) {
      fail(entry.second, option->name + " " + e.what());
    }
  }
}

void StrictYaml::checkList(const YAML::Node& list, const std::string& field) const {
  if (!list.IsSequence() || list.size() == 0) fail(list, field + ": expected a list");
}

YAML::Node StrictYaml::required(const YAML::Node& map, const std::string& key) const {
  const YAML::Node found = map[key];
  if (!found) fail(map, "key '" + key + "' is missing");
  return found;
}

std::string StrictYaml::text(const YAML::Node& node, const std::string& field) const {
  if (!node.IsScalar()) fail(node, field + ": expected a word");
  return node.Scalar();
}

std::string StrictYaml::quoted(const YAML::Node& node) {
  return node.IsScalar() ? "'" + node.Scalar() + "'" : "something else";
}

double StrictYaml::number(const YAML::Node& node, const std::string& field) const {
  double value = NAN;
  if (!decode(node, value) || !std::isfinite(value))
    fail(node, field + ": expected a number, found " + quoted(node));
  return value;
}

double StrictYaml::whole(const YAML::Node& node, const std::string& expected, double low,
                         double high) const {
  double value = NAN;
  if (!decode(node, value) || value != std::floor(value) || value < low || value > high ||
      std::fabs(value) >= 0x1p53)  // others are rounded
    fail(node, "expected " + expected + ", found " + quoted(node));
  return value;
}

double StrictYaml::notNegative(const YAML::Node& node, const std::string& field) const {
  const double value = number(node, field);
  if (value < 0) fail(node, field + ": expected a number >= 0, found " + node.Scalar());
  return value;
}

Eigen::Vector3d StrictYaml::point(const YAML::Node& node, const std::string& field) const {
  if (!node.IsSequence() || node.size() != 3) fail(node, field + ": expected [x, y, z]");
  return {number(node[0], field), number(node[1], field), number(node[2], field)};
}

}  // namespace strict_files
