#include "IncludeRules.h"

#include <optional>
#include <regex>

#include "SourceTree.h"

namespace fs = std::filesystem;

const IncludeTable& includeTable() {
  static const IncludeTable table = {
      {"strict_files", {"Eigen", "fcntl.h", "sys", "unistd.h", "yaml-cpp"}},
      {"semantic_types", {"Eigen", "yaml-cpp", "strict_files"}},
      {"tree_abstraction", {}},
      {"semantic_octree", {"Eigen", "octomap", "zlib.h", "semantic_types", "strict_files"}},
      {"view_information", {"semantic_octree", "tree_abstraction"}},
      {"semantic_abstraction",
       {"Eigen", "semantic_octree", "semantic_octree/store", "semantic_types", "strict_files",
        "tree_abstraction"}},
      {"map_folders", {"Eigen", "semantic_octree", "semantic_octree/store", "strict_files"}},
      {"map_streams",
       {"zlib.h", "semantic_abstraction", "semantic_octree", "semantic_octree/store",
        "tree_abstraction"}},
      {"map_correction",
       {"Eigen", "semantic_octree", "semantic_octree/store", "semantic_types", "strict_files"}},
      {"map_operations",
       {"Eigen", "octomap", "semantic_octree", "semantic_octree/store", "semantic_types",
        "strict_files"}},
      {"mrpt_compat", {"mrpt", "opencv2"}},
      {"labeled_cloud",
       {"Eigen", "lzf.h", "mrpt", "opencv2", "png.h", "yaml-cpp", "zlib.h", "zstd.h",
        "semantic_types", "strict_files", "mrpt_compat"}},
      {"semantic_map",
       {"Eigen", "mrpt", "octomap", "opencv2", "zlib.h", "labeled_cloud", "mrpt_compat",
        "map_folders", "map_operations", "semantic_abstraction", "semantic_octree",
        "semantic_types", "strict_files", "tree_abstraction"}},
      {"map_pictures",
       {"Eigen", "ft2build.h", "gif_lib.h", "mrpt", "octomap", "opencv2", "mrpt_compat",
        "semantic_octree", "semantic_types", "strict_files"}},
      {"map_view",
       {"Eigen", "yaml-cpp", "semantic_abstraction", "semantic_octree", "semantic_types",
        "strict_files", "tree_abstraction"}},
      {"colored_graph", {}},
      {"semantic_planning/vehicle", {"Eigen", "mrpt", "semantic_types", "strict_files"}},
      {"semantic_planning/ground",
       {"colored_graph", "semantic_octree", "semantic_types", "strict_files",
        "semantic_planning/vehicle"}},
      {"semantic_planning/roadmap",
       {"mrpt", "colored_graph", "semantic_abstraction", "semantic_octree", "strict_files",
        "semantic_planning/vehicle", "semantic_planning/ground"}},
      {"semantic_planning/planner",
       {"Eigen", "mrpt", "colored_graph", "semantic_abstraction", "semantic_octree",
        "semantic_types", "strict_files", "semantic_planning/vehicle", "semantic_planning/ground",
        "semantic_planning/roadmap"}},
      {"semantic_driving",
       {"Eigen", "mrpt", "octomap", "colored_graph", "mrpt_compat", "semantic_abstraction",
        "semantic_types", "strict_files", "semantic_planning", "view_information"}},
      {"synthetic_world", {"Eigen", "semantic_types", "strict_files"}},
      {"semantic_slam",
       {"Eigen", "map_correction", "map_operations", "semantic_octree", "semantic_types",
        "strict_files"}},
      {"semantic_navigation",
       {"Eigen", "mrpt", "colored_graph", "semantic_abstraction", "semantic_driving",
        "semantic_octree", "semantic_planning", "semantic_slam", "semantic_types",
        "tree_abstraction"}},
      {"python",
       {"Eigen", "pybind11", "colored_graph", "map_operations", "semantic_abstraction",
        "semantic_octree", "semantic_planning", "semantic_types", "strict_files"}},
  };
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
