#pragma once
#include <map_folders/MapFolder.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "Terminal.h"

namespace inputs {

/** What help calls a map. */
constexpr const char* kMap = ".semantic, a folder of tiles, or OctoMap's .ot and .bt";

/** MAP, the argument of programs that read one. */
CLI::Option* addMap(CLI::App& app, std::filesystem::path& map);

/** OctoMap's file, by its ending: .ot or .bt. */
bool isOctomaps(const std::filesystem::path& file);
/** The map of OctoMap's file (semantic_map::importOctomapFile()); none: it is not OctoMap's.
 * \throw std::runtime_error naming the file; also if it is a folder of results, and which of these
 * is a map. */
std::optional<semantic_octree::SemanticOcTree> octomapIn(const std::filesystem::path& file);

/** Any map. \param memory of a folder of tiles, MB; wanted: see MapFolderOptions
 * \throw std::runtime_error as octomapIn() and StoredMap */
std::unique_ptr<semantic_octree::StoredMap> openMap(
    const std::filesystem::path& path, double memory,
    decltype(semantic_octree::MapFolderOptions::wanted) wanted = {});
/** Opens any map behind those that are open. */
template <typename Maps>
void appendMap(Maps& maps, const std::filesystem::path& path, double memory) {
  if (auto octomap = octomapIn(path))
    maps.emplace_back(std::move(*octomap));
  else
    maps.emplace_back(path, memory);
}
/** All of a map. \throw std::runtime_error as openMap() */
semantic_octree::SemanticOcTree loadMap(const std::filesystem::path& path);

/** While it lives, it says how many tiles of folders were read. How far maps of single files are,
 * nobody knows. */
class TileProgress {
 public:
  /** \param maps gone through together \param task "Exporting" */
  TileProgress(const std::vector<semantic_octree::StoredMap*>& maps, const std::string& task);
  ~TileProgress();
  TileProgress(const TileProgress&) = delete;
  TileProgress& operator=(const TileProgress&) = delete;

 private:
  std::vector<semantic_octree::MapFolder*> m_folders;
  std::set<std::pair<const semantic_octree::MapFolder*, std::size_t>> m_read;
  Progress m_progress;
};

/** \throw std::runtime_error naming the first that is given twice: it would count twice. */
void checkOnce(const std::vector<std::filesystem::path>& files);

/** \throw std::runtime_error naming the first that is given twice, or is a folder or another kind
 * of file, and which command makes a rawlog of it. */
void checkRawlogs(const std::vector<std::filesystem::path>& files);

}  // namespace inputs
