#include <strict_files/StrictYaml.h>

#include <strict_files/IniSection.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cctype>
#include <cmath>
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

std::string yamlText(const std::string& text) {
  YAML::Emitter out;
  out << YAML::Flow << YAML::BeginSeq << text << YAML::EndSeq;
  const std::string list = out.c_str();  // "[text]"
  return list.substr(1, list.size() - 2);
}

StrictYaml::StrictYaml(const std::filesystem::path& file) : m_file(file.string()) {
  parse(readText(file));
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

namespace {

/** What a file is that has keys of another kind of file; empty if it has none of these. */
std::string kindOf(const YAML::Node& root, const std::set<std::string>& known) {
  static const std::pair<const char*, const char*> kinds[] = {
      {"output", "this is a network's configuration"},
      {"confusion", "this is a confusion matrix"},
      {"classes", "this is a class table"},
      {"best_to_worst", "this is an order of classes"},
      {"solutions", "these are weights of classes"},
      {"relevant", "these are weights of classes"},
      {"turning_radius", "this is a vehicle"}};
  for (const auto& [key, kind] : kinds)
    if (root[key] && !known.count(key)) return kind;
  return {};
}

}  // namespace

void StrictYaml::checkKeys(const YAML::Node& map, const std::set<std::string>& known) const {
  checkMap(map);
  if (const std::string kind = map.is(m_root) ? kindOf(map, known) : ""; !kind.empty())
    fail(map, kind + "; expected the keys " + joined({known.begin(), known.end()}));
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

namespace {

bool sameButCase(const std::string& a, const std::string& b) {
  const auto same = [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace

std::optional<std::string> IniSection::text(const std::string& key) {
  m_known.push_back(key);
  for (const auto& [present, value] : m_entries) {
    if (!sameWord(present, key)) continue;
    const std::string line = " " + value;
    std::size_t end = line.size();
    for (const char* mark : {" //", " #", " ;", "\t//", "\t#", "\t;"})
      end = std::min(end, line.find(mark));
    return trimmed(line.substr(0, end));
  }
  return std::nullopt;
}

void IniSection::read(const OptionList& list) {
  for (const Option& option : list.options()) {
    const auto found = text(option.name);
    if (!found) continue;
    try {
      option.set(*found);
    } catch (const std::invalid_argument& e) {
      fail(option.name + " " + e.what());
    }
  }
}

void IniSection::fail(const std::string& what) const {
  throw std::runtime_error("[" + m_section + "] " + what);
}

void IniSection::finish() const {
  for (const auto& [key, value] : m_entries) {
    const auto same = [&key = key](const std::string& known) { return sameWord(known, key); };
    if (std::none_of(m_known.begin(), m_known.end(), same)) fail(unknownWord("key", key, m_known));
  }
}

void checkIniText(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> keys;
  bool continues = false;
  int number = 0;
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error("line " + std::to_string(number) + ": " + what);
  };
  for (std::string raw; ++number, std::getline(stream, raw);) {
    const std::string line = trimmed(raw);
    const bool isContinuation = continues;
    continues = !line.empty() && line.back() == '\\';
    const bool isComment = line.empty() || line[0] == '#' || line[0] == ';' || line[0] == '@' ||
                           line.compare(0, 2, "//") == 0;
    if (isContinuation || isComment) continue;
    if (line[0] == '[') {
      if (line.find(']') == std::string::npos) refuse("'" + line + "' has no ']'");
      keys.clear();
      continue;
    }
    const std::string key = trimmed(line.substr(0, line.find('=')));
    if (line.find('=') == std::string::npos || key.empty())
      refuse("'" + line + "', expected key = value");
    const auto same = [&key](const std::string& known) { return sameWord(known, key); };
    if (std::any_of(keys.begin(), keys.end(), same)) refuse("key '" + key + "' twice");
    keys.push_back(key);
  }
}

void checkSection(const std::string& section, const std::vector<std::string>& known) {
  for (const std::string& name : known) {
    const bool isPrefix = !name.empty() && name.back() == '*';
    const std::size_t length = isPrefix ? name.size() - 1 : std::max(name.size(), section.size());
    if (sameButCase(section.substr(0, length), name.substr(0, length))) return;
  }
  throw std::runtime_error("[" + section + "] " + unknownWord("section", section, known));
}

}  // namespace strict_files
