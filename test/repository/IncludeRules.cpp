#include "IncludeRules.h"

#include <optional>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

IncludeTable includeTable(const fs::path& markdownFile) {
  static const std::regex row(R"(^\| `([a-z_/]+)` \| ([\w., /-]+) \|$)"), name(R"([\w./-]+)");
  IncludeTable table;
  bool isInTable = false;
  for (const SourceLine& line : linesOf(markdownFile)) {
    isInTable = line.text.rfind("| library or room |", 0) == 0 || (isInTable && !line.text.empty());
    std::smatch match;
    if (!isInTable || !std::regex_match(line.text, match, row)) continue;
    const std::string names = match[2] == "nothing" ? "" : match[2].str();
    table[match[1]] = {std::sregex_token_iterator(names.begin(), names.end(), name), {}};
  }
  return table;
}

namespace {

/** The folder of headers that a library has for some others, and does not install. */
const std::string kStore = "store";

struct Include {
  bool quoted;
  std::string path;
};

std::optional<Include> parseInclude(const std::string& line) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::smatch match;
  if (!std::regex_search(line, match, pattern)) return std::nullopt;
  return Include{match[1] == "\"", match[2]};
}

/** "library", or "library/room" for a file in a folder of include/library/ or of src/. What is in
 * store/ is of the library itself. */
std::string roomOf(const fs::path& file, const fs::path& libs) {
  const fs::path relative = file.lexically_relative(libs);
  std::vector<std::string> parts(relative.begin(), relative.end());
  parts.pop_back();
  const std::string library = parts.front();
  if (parts.size() > 1 && parts[1] == kStore) return library;
  const std::size_t above = parts.size() > 1 && parts[1] == "include" ? 3 : 2;
  return parts.size() > above ? library + "/" + parts[above] : library;
}

/** What the table calls the includes of a path: "mrpt", and the first two parts, "library/room".
 * Who may include a library may not yet include what is in its store/. */
std::vector<std::string> namesOf(const fs::path& path) {
  std::vector<std::string> names;
  const std::vector<std::string> parts(path.begin(), path.end());
  if (!parts.empty() && (parts.size() < 3 || parts[1] != kStore)) names.push_back(parts[0]);
  if (parts.size() > 2) names.push_back(parts[0] + "/" + parts[1]);
  return names;
}

/** Why the include does not belong into this file, or nothing. */
std::optional<std::string> objection(const Include& include, const fs::path& file,
                                     const std::string& room,
                                     const std::set<std::string>& allowed) {
  if (include.path == "iostream") return "prints: <iostream> belongs to applications";
  const fs::path library = *fs::path(room).begin();
  const bool upwards = include.path.rfind("..", 0) == 0;
  if (include.quoted && !upwards && fs::exists(file.parent_path() / include.path)) return {};
  // Between the rooms of a library, quotes name a file from its src/ on.
  const fs::path path =
      include.quoted && !upwards ? library / include.path : fs::path(include.path);
  for (const std::string& name : namesOf(path))
    if (name == room || name == room + "/" + kStore || allowed.count(name)) return {};
  const bool standard = include.path.find_first_of("./") == std::string::npos;
  if (standard) return {};
  return room + " may not include " + include.path;
}

}  // namespace

std::vector<std::string> forbiddenIncludes(const fs::path& libs, const IncludeTable& table) {
  std::vector<std::string> findings;
  for (const SourceLine& line : linesOfSources(libs)) {
    const std::string room = roomOf(line.file, libs);
    const auto include = parseInclude(line.text);
    if (!include) continue;
    const auto row = table.find(room);
    const auto problem = row == table.end() ? room + " has no row in the table of includes"
                                            : objection(*include, line.file, room, row->second);
    if (problem) findings.push_back(line.where(libs) + ": " + *problem);
  }
  return findings;
}

std::vector<std::string> algorithmsWithoutTheirHeader(const fs::path& root) {
  static const std::regex call(
      R"(std::((stable_|partial_)?sort|nth_element|find(_if(_not)?)?|(all|any|none)_of|count(_if)?)"
      R"(|copy(_if|_n)?|fill(_n)?|shuffle|reverse|rotate|unique|remove_if|(lower|upper)_bound)"
      R"(|equal(_range)?|binary_search|(min|max|minmax)_element|minmax|clamp|adjacent_find|search)"
      R"(|includes|set_(union|difference|intersection)|next_permutation|(push|pop|make)_heap)\()");
  std::vector<std::string> findings;
  std::set<fs::path> known;  // files that include it, or were found already
  for (const SourceLine& line : linesOfSources(root)) {
    std::smatch match;
    if (line.text == "#include <algorithm>") known.insert(line.file);
    if (!std::regex_search(line.text, match, call) || !known.insert(line.file).second) continue;
    findings.push_back(line.where(root) + ": std::" + match[1].str() + " needs <algorithm>");
  }
  return findings;
}
