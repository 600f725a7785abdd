#include <map_folders/MapFolder.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/OutputFiles.h>

#include <limits>

#include "TileIndex.h"

namespace semantic_octree {

namespace fs = std::filesystem;

namespace {

SemanticOcTree beginningOf(const fs::path& path) {
  return MapFolder::isAt(path) ? MapFolder::emptyMap(path) : loadTree(path.string());
}

}  // namespace

StoredMap::StoredMap(const fs::path& path, double memory, decltype(MapFolderOptions::wanted) wanted)
    : m_tree(beginningOf(path)) {
  MapFolderOptions options;
  options.memory = memory;
  options.wanted = std::move(wanted);
  open(path, MapFolder::Access::Read, options);
}

StoredMap::StoredMap(const fs::path& path, const MapFolderOptions& options)
    : m_tree(beginningOf(path)) {
  open(path, MapFolder::Access::Draft, options);
}

void StoredMap::open(const fs::path& path, MapFolder::Access access,
                     const MapFolderOptions& options) {
  if (!MapFolder::isAt(path)) {
    m_bytesOnDisk = fs::file_size(path);
    return;
  }
  m_folder = std::make_unique<MapFolder>(m_tree, path, access, options);
  m_bytesOnDisk = m_folder->contents().bytesOnDisk;
}

StoredMap::StoredMap(SemanticOcTree empty, const fs::path& folder, const MapFolderOptions& options)
    : m_tree(std::move(empty)),
      m_folder(std::make_unique<MapFolder>(m_tree, folder, MapFolder::Access::Replace, options)) {}

bool MapFolder::isAt(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / MapFolder::kIndexFile, ignored);
}

MapFolder::Others MapFolder::othersAt(const fs::path& folder) {
  const strict_files::FileLock lock(folder / TileIndex::kReadersLock,
                                    strict_files::FileLock::Kind::Shared);
  const TileIndex index = readIndex(folder);
  std::set<std::string> names = index.files();
  names.insert(index.old.begin(), index.old.end());
  names.insert({kIndexFile, TileIndex::kWriterLock, TileIndex::kReadersLock});
  Others others;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || names.count(entry.path().filename().string())) continue;
    ++others.files;
    others.bytes += entry.file_size();
  }
  return others;
}

SemanticOcTree loadMap(const fs::path& path) {
  if (!MapFolder::isAt(path)) return loadTree(path.string());
  SemanticOcTree map = MapFolder::emptyMap(path);
  MapFolderOptions options;
  options.memory = std::numeric_limits<double>::max();
  MapFolder(map, path, MapFolder::Access::Read, options).bringAll();
  return map;
}

}  // namespace semantic_octree
