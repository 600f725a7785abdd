#include <map_folders/MapFolder.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/TreeFormat.h>

#include <limits>

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

SemanticOcTree loadMap(const fs::path& path) {
  if (!MapFolder::isAt(path)) return loadTree(path.string());
  SemanticOcTree map = MapFolder::emptyMap(path);
  MapFolderOptions options;
  options.memory = std::numeric_limits<double>::max();
  MapFolder(map, path, MapFolder::Access::Read, options).bringAll();
  return map;
}

}  // namespace semantic_octree
