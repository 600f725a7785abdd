#include <map_folders/MapFolder.h>

#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/TreeBuilder.h>
#include <semantic_octree/store/TreeFormat.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <set>
#include <stdexcept>
#include <system_error>

#include "TilesOnDisk.h"

namespace semantic_octree {

namespace fs = std::filesystem;
using strict_files::FileLock;

namespace {

/** Right after FileLock::tryTo(), which says no also if it cannot know. */
std::string whyNotLocked() {
  if (errno == EWOULDBLOCK) return "another process writes into this folder";
  return std::generic_category().message(errno);
}

/** A map without its tiles. */
class LeavesCursor {
 public:
  LeavesCursor(int numClasses, int tileDepth, const Node& node, int depth)
      : m_numClasses(numClasses), m_tileDepth(tileDepth), m_node(node), m_depth(depth) {}
  bool known() const { return m_node && (m_node.isLeaf() || m_depth < m_tileDepth); }
  bool isLeaf() const { return m_node.isLeaf(); }
  LeafContent content() const { return contentOf(m_node, m_numClasses); }
  LeavesCursor child(int i) const {
    return {m_numClasses, m_tileDepth, m_node.isLeaf() ? m_node : m_node.child(i), m_depth + 1};
  }

 private:
  int m_numClasses, m_tileDepth;
  Node m_node;
  int m_depth;
};

Cube cellOf(const TreeIterator& node) {
  const auto key = node.getIndexKey();
  return {{key[0], key[1], key[2]}, static_cast<int>(node.getDepth())};
}

std::vector<std::string> namesOf(const ClassTable& classes) {
  std::vector<std::string> names;
  for (int id = 1; id <= classes.size(); ++id)
    names.push_back(classes.name(static_cast<semantic_types::ClassId>(id)));
  return names;
}

std::vector<Cube> cellsOf(const SemanticOcTree& leaves) {
  std::vector<Cube> cells;
  for (auto leaf = leaves.begin_leafs(); leaf != leaves.end_leafs(); ++leaf)
    cells.push_back(cellOf(leaf));
  return cells;
}

SemanticOcTree loadLeaves(const fs::path& folder, const TileIndex& index) {
  const fs::path file = folder / TileIndex::leavesName(index.generation);
  std::uint32_t checksum = 0;
  SemanticOcTree leaves = loadTreeFile(file.string(), &checksum);
  const auto refuse = [&file](const std::string& why) {
    throw std::runtime_error("cannot load map '" + file.string() + "': " + why);
  };
  if (leaves.getResolution() != index.resolution || namesOf(leaves.classes()) != index.classes)
    refuse(std::string("it has another resolution or other classes than ") + MapFolder::kIndexFile +
           " says");
  if (checksum != index.leavesChecksum || cellsOf(leaves) != index.leaves)
    refuse(std::string("it is not the file that ") + MapFolder::kIndexFile + " names: checksum " +
           std::to_string(checksum) + ", expected " + std::to_string(index.leavesChecksum) +
           " and the leaves that it lists");
  return leaves;
}

}  // namespace

MapFolder::Tiles::Tiles(SemanticOcTree& map, fs::path folder, Access access,
                        const MapFolderOptions& options)
    : m_map(map), m_folder(std::move(folder)), m_access(access) {
  options.validate();
  if (!map.empty() || store().tiles())
    throw std::invalid_argument("a map for a folder of tiles has to be empty, and in no other one");
  m_index = open(options);
  constexpr double kAll = 1e18;  // bytes
  m_budget = static_cast<std::size_t>(std::min(options.memory * 1e6, kAll));
  m_next = saves() ? nextGeneration(m_folder, m_index) : m_index.generation + 1;
  auto empty = std::make_unique<NodeStore>(store().stateBytes());
  const std::int64_t clock = MapAccess::clock(map);
  try {
    if (m_index.generation > 0 && access != Access::Replace) takeContents();
    store().setTiles(this);
    MapAccess::recomputeTileByTile(map);
  } catch (...) {
    MapAccess::setStore(map, std::move(empty));
    MapAccess::setClock(map, clock);
    throw;
  }
}

MapFolder::Tiles::~Tiles() {
  if (isOfMap()) store().setTiles(nullptr);
  removePlaced();
}

void MapFolder::Tiles::save() {
  if (!isOfMap()) throw std::logic_error("saving a map that is no longer the folder's");
  if (!saves()) throw std::logic_error("saving a map whose folder was opened to be read");
  TileIndex index = writeChanged();
  SemanticOcTree leaves = emptyLike(m_map);
  TreeBuilder::fill(leaves, LeavesCursor(m_map.numClasses(), index.depth, m_map.root(), 0),
                    TreeBuilder::Merge::Never);
  index.leaves = cellsOf(leaves);
  index.leavesChecksum =
      saveTreeFile(leaves, m_unsaved->staged(TileIndex::leavesName(index.generation)).string());
  index.old = oldFor(index);
  writeIndex(m_unsaved->staged(""), index);
  place(index);
  m_index = std::move(index);
  m_next = m_index.generation + 1;
  m_placed.clear();
  removeOld();
}

TileIndex MapFolder::Tiles::open(const MapFolderOptions& options) {
  if (saves()) {
    m_unsaved.emplace(m_folder);
    m_writer = FileLock::tryTo(m_folder / TileIndex::kWriterLock, FileLock::Kind::Exclusive);
    if (!m_writer) throw std::runtime_error(m_folder.string() + ": " + whyNotLocked());
    m_unsaved->takeAlong(TileIndex::kWriterLock);
  } else {
    m_reader.emplace(m_folder / TileIndex::kReadersLock, FileLock::Kind::Shared);
    if (!options.draft.empty()) m_unsaved.emplace(options.draft);
  }
  const bool wasSaved = isAt(m_folder);
  TileIndex index;
  if (!saves() || (wasSaved && m_access == Access::Write)) {
    index = readIndex(m_folder);
    if (m_access == Access::Read && options.wanted) index.keepWanted(options.wanted);
    return index;
  }
  if (wasSaved) {
    const TileIndex before = readIndex(m_folder);
    const std::set<std::string> files = before.files();
    index.generation = before.generation;
    index.old = before.old;
    index.old.insert(index.old.end(), files.begin(), files.end());
  }
  index.resolution = m_map.getResolution();
  index.depth = depthOfTiles(options.tileSize, index.resolution);
  index.classes = namesOf(m_map.classes());
  return index;
}

void MapFolder::Tiles::takeContents() {
  SemanticOcTree leaves = loadLeaves(m_folder, m_index);
  leaves.setHalfLives(m_map.classes());
  MapAccess::setClock(m_map, MapAccess::clock(leaves));
  if (emptyLike(leaves) != emptyLike(m_map))
    throw std::runtime_error(m_folder.string() +
                             ": its map has another resolution, other classes or parameters");
  MapAccess::setStore(
      m_map, MapAccess::store(leaves).copy(store().stateBytes(), NodeStore::Tiles::StayAway));
  addFromIndex();
  if (m_access != Access::Write) return;
  for (const std::string& name : m_index.files())
    if (!fs::exists(m_folder / name))
      throw std::runtime_error("cannot load map '" + (m_folder / name).string() +
                               "': it is missing, and " + kIndexFile + " names it");
  removeOld();
}

/** What the next index calls old: files that are there, and that it does not need. */
std::vector<std::string> MapFolder::Tiles::oldFor(const TileIndex& next) const {
  std::set<std::string> files = m_index.files();
  files.insert(m_index.old.begin(), m_index.old.end());
  files.insert(m_placed.begin(), m_placed.end());
  for (const std::string& name : next.files()) files.erase(name);
  std::vector<std::string> old;
  for (const std::string& name : files)
    if (fs::exists(m_folder / name)) old.push_back(name);
  return old;
}

/** Puts files that are not in the folder yet there, the index last. */
void MapFolder::Tiles::place(const TileIndex& index) {
  std::vector<std::string> names;
  for (const std::string& name : index.files())
    if (fs::exists(m_unsaved->staged(name))) names.push_back(name);
  m_placed.insert(names.begin(), names.end());
  names.push_back(kIndexFile);
  m_unsaved->commit(names);
}

namespace {

template <class Names>
void remove(const fs::path& folder, const Names& names) {
  std::error_code ignored;
  for (const std::string& name : names) fs::remove(folder / name, ignored);
}

}  // namespace

/** Unless somebody may still want them. */
void MapFolder::Tiles::removeOld() const {
  const auto alone = FileLock::tryTo(m_folder / TileIndex::kReadersLock, FileLock::Kind::Exclusive);
  if (alone) remove(m_folder, m_index.old);
}

/** What a save put there that then failed, unless the index had taken its place. */
void MapFolder::Tiles::removePlaced() {
  if (m_placed.empty()) return;
  try {
    if (isAt(m_folder))
      for (const std::string& name : readIndex(m_folder).files()) m_placed.erase(name);
    remove(m_folder, m_placed);
  } catch (const std::exception&) {  // then they stay
  }
}

SemanticOcTree MapFolder::emptyMap(const fs::path& folder) {
  const FileLock lock(folder / TileIndex::kReadersLock, FileLock::Kind::Shared);
  return emptyLike(loadLeaves(folder, readIndex(folder)));
}

MapFolder::MapFolder(SemanticOcTree& map, const fs::path& folder, Access access,
                     const MapFolderOptions& options)
    : m(std::make_unique<Tiles>(map, folder, access, options)) {}

MapFolder::~MapFolder() = default;

void MapFolder::save() { m->save(); }

void MapFolder::checkFits(std::optional<std::size_t> available) const { m->checkFits(available); }

void MapFolder::bringAll(std::optional<std::size_t> available) {
  m->checkFits(available);
  m->bringAll();
}

void MapFolder::onTile(std::function<void(std::size_t)> told) { m->onTile(std::move(told)); }

std::vector<std::string> MapFolder::problems() { return m->problems(); }

MapFolder::Contents MapFolder::contents() const { return m->contents(); }

using strict_files::above;
using strict_files::atLeast;

void MapFolderOptions::describe(strict_files::OptionList& list) {
  list.add("memory", memory, "MB", atLeast(0), "memory for tiles; a scan may need more");
  list.add("tile_size", tileSize, "m", above(0),
           "edge of a new folder's tiles, rounded down to 8, 16, 32 ... voxels");
}

void MapFolderOptions::validate() const { strict_files::checkOptions(*this, "MapFolderOptions"); }

namespace {

SemanticOcTree beginningOf(const fs::path& path) {
  return MapFolder::isAt(path) ? MapFolder::emptyMap(path) : loadTree(path.string());
}

}  // namespace

StoredMap::StoredMap(const fs::path& path, const MapFolderOptions& options)
    : m_tree(beginningOf(path)) {
  if (!MapFolder::isAt(path)) {
    m_bytesOnDisk = fs::file_size(path);
    return;
  }
  m_folder = std::make_unique<MapFolder>(m_tree, path, MapFolder::Access::Read, options);
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
  const FileLock lock(folder / TileIndex::kReadersLock, FileLock::Kind::Shared);
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
