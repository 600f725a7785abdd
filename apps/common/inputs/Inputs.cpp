#include "Inputs.h"

#include <semantic_map/MapFiles.h>

#include <algorithm>
#include <fstream>

namespace inputs {

namespace fs = std::filesystem;
using semantic_octree::MapFolder;
using semantic_octree::SemanticOcTree;
using semantic_octree::StoredMap;

namespace {

/** The first file of a folder, by name, with one of these endings. */
std::optional<fs::path> fileIn(const fs::path& folder, const std::vector<std::string>& endings) {
  std::optional<fs::path> first;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (std::find(endings.begin(), endings.end(), entry.path().extension()) != endings.end() &&
        (!first || entry.path() < *first))
      first = entry.path();
  return first;
}

/** Programs write maps into folders of results. */
void checkNoResults(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored) || MapFolder::isAt(path)) return;
  std::optional<fs::path> meant = fileIn(path, {".semantic"});
  if (fs::exists(path / "map.semantic")) meant = path / "map.semantic";
  if (MapFolder::isAt(path / "tiles")) meant = path / "tiles";
  if (meant)
    throw std::runtime_error(path.string() + ": is a folder of results; did you mean '" +
                             meant->string() + "'?");
}

/** With the command that makes a rawlog of it. */
std::string makesOne(const std::string& what, const std::string& kind, const fs::path& source) {
  const fs::path path = source.has_filename() ? source : source.parent_path();
  const std::string files = kind == "pcd" && fs::is_directory(path) ? "/*" : "";
  const std::string classes = kind == "carmen" ? "" : " --classes TABLE.yaml";
  return what + "; dataset2rawlog " + kind + " " + path.string() + files + classes + " -o " +
         path.stem().string() + ".rawlog makes a rawlog of it";
}

/** Empty: may be a rawlog. */
std::string kindOfFolder(const fs::path& folder) {
  if (fs::exists(folder / "velodyne"))
    return makesOne("a KITTI sequence", "semantic-kitti", folder);
  if (fs::exists(folder / "depth.txt")) return makesOne("a TUM RGB-D sequence", "tum", folder);
  if (fileIn(folder, {".mcap", ".db3"})) return makesOne("a bag of ROS 2", "rosbag2", folder);
  if (fileIn(folder, {".pcd"})) return makesOne("a folder of point clouds", "pcd", folder);
  if (MapFolder::isAt(folder)) return "a map";
  const auto rawlog = fileIn(folder, {".rawlog"});
  return "a folder" + (rawlog ? "; did you mean '" + rawlog->string() + "'?" : "");
}

bool isCarmens(const fs::path& file) {
  std::ifstream in(file);
  std::string begin(1 << 16, '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find("\nFLASER ") != std::string::npos ||
         begin.find("\nROBOTLASER1 ") != std::string::npos;
}

std::string kindOfFile(const fs::path& file) {
  const std::string ending = file.extension();
  if (ending == ".mcap" || ending == ".db3") return makesOne("a bag of ROS 2", "rosbag2", file);
  if (ending == ".pcd") return makesOne("a point cloud", "pcd", file);
  if (ending == ".semantic") return "a map";
  if ((ending == ".log" || ending == ".clf") && isCarmens(file))
    return makesOne("a log of CARMEN", "carmen", file);
  return {};
}

}  // namespace

CLI::Option* addMap(CLI::App& app, fs::path& map) {
  return app.add_option("MAP", map, std::string("Map: ") + kMap)->required();
}

bool isOctomaps(const fs::path& file) {
  return file.extension() == ".ot" || file.extension() == ".bt";
}

std::optional<SemanticOcTree> octomapIn(const fs::path& file) {
  checkNoResults(file);
  if (!isOctomaps(file)) return std::nullopt;
  return semantic_map::importOctomapFile(file);
}

std::unique_ptr<StoredMap> openMap(const fs::path& path, double memory,
                                   decltype(semantic_octree::MapFolderOptions::wanted) wanted) {
  if (auto octomap = octomapIn(path)) return std::make_unique<StoredMap>(std::move(*octomap));
  return std::make_unique<StoredMap>(path, memory, std::move(wanted));
}

SemanticOcTree loadMap(const fs::path& path) {
  if (auto octomap = octomapIn(path)) return std::move(*octomap);
  return semantic_octree::loadMap(path);
}

namespace {

std::size_t tilesOf(const std::vector<StoredMap*>& maps) {
  std::size_t tiles = 0;
  for (StoredMap* map : maps)
    if (const MapFolder* folder = map->folder()) tiles += folder->contents().tiles;
  return tiles;
}

}  // namespace

TileProgress::TileProgress(const std::vector<StoredMap*>& maps, const std::string& task)
    : m_progress(task, tilesOf(maps)) {
  const std::string ofAll = " of " + std::to_string(tilesOf(maps)) + " tiles";
  for (StoredMap* map : maps) {
    MapFolder* const folder = map->folder();
    if (!folder) continue;
    m_folders.push_back(folder);
    folder->onTile([this, folder, ofAll](std::size_t number) {  // they may come again
      m_read.emplace(folder, number);
      m_progress.update(m_read.size(), std::to_string(m_read.size()) + ofAll);
    });
  }
  if (m_folders.empty()) m_progress.update(0, "all of the map");
}

TileProgress::~TileProgress() {
  for (MapFolder* folder : m_folders) folder->onTile({});
}

void checkOnce(const std::vector<fs::path>& files) {
  std::set<fs::path> seen;
  for (const fs::path& file : files)
    if (!seen.insert(file.lexically_normal()).second)
      throw std::runtime_error(file.string() + ": is given twice");
}

void checkRawlogs(const std::vector<fs::path>& files) {
  checkOnce(files);
  for (const fs::path& file : files) {
    std::error_code ignored;
    const bool isFolder = fs::is_directory(file, ignored);
    const std::string kind = isFolder ? kindOfFolder(file) : kindOfFile(file);
    if (!kind.empty()) throw std::runtime_error(file.string() + ": is no rawlog, but " + kind);
  }
}

}  // namespace inputs
