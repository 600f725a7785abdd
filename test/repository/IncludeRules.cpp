#include "IncludeRules.h"

#include <optional>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

const IncludeTable& includeTable() {
  static const IncludeTable table = {
      {"tree_abstraction", {"Eigen"}},
      {"semantic_octree", {"Eigen", "octomap", "zlib.h", "tree_abstraction"}},
      {"labeled_cloud",
       {"Eigen", "mrpt", "opencv2", "png.h", "yaml-cpp", "zlib.h", "semantic_octree"}},
      {"semantic_map",
       {"Eigen", "mrpt", "octomap", "opencv2", "zlib.h", "labeled_cloud", "semantic_octree",
        "tree_abstraction"}},
      {"colored_graph", {}},
      {"semantic_planning",
       {"Eigen", "mrpt", "octomap", "ompl", "yaml-cpp", "colored_graph", "labeled_cloud",
        "semantic_octree", "tree_abstraction"}},
      {"synthetic_world", {"Eigen", "semantic_octree"}},
  };
  return table;
}

namespace {

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

/** Why the include does not belong into this file, or nothing. */
std::optional<std::string> objection(const Include& include, const fs::path& file,
                                     const std::string& library,
                                     const std::set<std::string>& allowed) {
  const std::string first = *fs::path(include.path).begin();
  if (include.path == "iostream") return "prints: <iostream> belongs to applications";
  if (include.quoted && first != ".." && fs::exists(file.parent_path() / include.path)) return {};
  if (first == library || allowed.count(first)) return {};
  const bool standard = include.path.find_first_of("./") == std::string::npos;
  if (standard) return {};
  return library + " may not include " + include.path;
}

}  // namespace

std::vector<std::string> forbiddenIncludes(const fs::path& libs, const IncludeTable& table) {
  std::vector<std::string> findings;
  for (const SourceLine& line : linesOfSources(libs)) {
    const std::string library = *line.file.lexically_relative(libs).begin();
    const auto include = parseInclude(line.text);
    if (!include) continue;
    const auto row = table.find(library);
    const auto problem = row == table.end()
                             ? "library " + library + " has no row in the table of includes"
                             : objection(*include, line.file, library, row->second);
    if (problem) findings.push_back(line.where(libs) + ": " + *problem);
  }
  return findings;
}
