#include <semantic_octree/MapFolder.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/AvailableMemory.h>
#include <strict_files/FileLock.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>

#include "TilesOnDisk.h"
#include "TreeBuilder.h"
#include "TreeFormat.h"

namespace semantic_octree {

namespace fs = std::filesystem;
using strict_files::FileLock;

namespace {

constexpr const char* kWriterLock = ".writer.lock";
constexpr const char* kReadersLock = ".readers.lock";

/** A map without its tiles. */
class LeavesCursor {
 public:
  LeavesCursor(const SemanticOcTree& map, int tileDepth, const Node& node, int depth)
      : m_map(map), m_tileDepth(tileDepth), m_node(node), m_depth(depth) {}
  bool known() const { return m_node && (m_node.isLeaf() || m_depth < m_tileDepth); }
  bool isLeaf() const { return m_node.isLeaf(); }
  LeafContent content() const { return contentOf(m_map, m_node); }
  LeavesCursor child(int i) const {
    return {m_map, m_tileDepth, m_node.isLeaf() ? m_node : m_node.child(i), m_depth + 1};
  }

 private:
  const SemanticOcTree& m_map;
  int m_tileDepth;
  Node m_node;
  int m_depth;
};

Cell cellOf(const TreeIterator& node) {
  const auto key = node.getIndexKey();
  const auto depth = static_cast<int>(node.getDepth());
  return {VoxelIndex(key[0], key[1], key[2]) / edgeAtDepth(depth), depth};
}

std::vector<std::string> namesOf(const ClassTable& classes) {
  std::vector<std::string> names;
  for (int id = 1; id <= classes.size(); ++id)
    names.push_back(classes.name(static_cast<semantic_types::ClassId>(id)));
  return names;
}

SemanticOcTree loadLeaves(const fs::path& folder, const TileIndex& index) {
  const fs::path file = folder / TileIndex::leavesName(index.generation);
  SemanticOcTree leaves = loadTreeFile(file.string());
  if (leaves.getResolution() != index.resolution || namesOf(leaves.classes()) != index.classes)
    throw std::runtime_error("cannot load map '" + file.string() +
                             "': it has another resolution or other classes than " +
                             MapFolder::kIndexFile + " says");
  return leaves;
}

/** Its tiles that are not wanted go. */
TileIndex onlyWanted(TileIndex index, const decltype(MapFolderOptions::wanted)& wanted) {
  if (!wanted) return index;
  const auto isUnwanted = [&](const TileIndex::Tile& tile) {
    const VoxelIndex origin = VoxelIndex::Constant(kKeyOfOrigin / edgeAtDepth(index.depth));
    const Eigen::Vector3d low = (tile.place - origin).matrix().cast<double>() * index.tileSize();
    return !wanted({low, low + Eigen::Vector3d::Constant(index.tileSize())});
  };
  index.tiles.erase(std::remove_if(index.tiles.begin(), index.tiles.end(), isUnwanted),
                    index.tiles.end());
  return index;
}

/** Of nodes and records, as maps of streets have them: 5 to 7. */
constexpr std::uint64_t kBytesOfLeaf = 6;

}  // namespace

class MapFolder::Tiles {
 public:
  Tiles(SemanticOcTree& map, fs::path folder, Access access, const MapFolderOptions& options)
      : m_map(map),
        m_folder(std::move(folder)),
        m_draft(access == Access::Draft ? options.draft : fs::path()),
        m_access(access) {
    options.validate();
    if (!map.empty()) throw std::invalid_argument("a map for a folder of tiles has to be empty");
    if (map.classes().hasHalfLives())
      throw std::invalid_argument(
          "a map of classes with half-lives cannot be in a folder of tiles");
    map.checkNotInTiles();
    if (access == Access::Draft && options.draft.empty())
      throw std::invalid_argument("a draft of a folder of tiles needs a place for what changes");
    TileIndex index = open(options);
    constexpr double kAll = 1e18;  // bytes
    const auto budget = static_cast<std::size_t>(std::min(options.memory * 1e6, kAll));
    const TilesOnDisk::Place place{m_folder, index.depth, budget, access != Access::Read,
                                   m_draft.empty() ? m_folder : m_draft};
    tiles = std::make_unique<TilesOnDisk>(map, place, std::move(index));
    auto empty = std::make_unique<NodeStore>(map.store().stateBytes());
    try {
      if (tiles->index().generation > 0 && access != Access::Replace) takeContents();
      map.store().setTiles(tiles.get());
      if (map.hasAbstraction()) map.computeTileByTile();
    } catch (...) {
      std::swap(map.m_store, empty);
      throw;
    }
  }
  ~Tiles() {
    if (isOfMap()) m_map.store().setTiles(nullptr);
    removeDraft();
  }

  void save() {
    if (!isOfMap()) throw std::logic_error("saving a map that is no longer the folder's");
    if (!saves()) throw std::logic_error("saving a map whose folder was opened to be read");
    TileIndex index = tiles->writeChanged();
    SemanticOcTree leaves = emptyLike(m_map);
    TreeBuilder::fill(leaves, LeavesCursor(m_map, index.depth, m_map.root(), 0),
                      TreeBuilder::Merge::Never);
    for (auto leaf = leaves.begin_leafs(); leaf != leaves.end_leafs(); ++leaf)
      index.leaves.push_back(cellOf(leaf));
    saveTree(leaves, (m_folder / TileIndex::leavesName(index.generation)).string());
    writeIndex(m_folder, index);
    tiles->setIndex(std::move(index));
    removeOthers();
  }

  void checkFits(std::optional<std::size_t> most) const {
    const std::uint64_t available = most.value_or(strict_files::availableMemory());
    const std::uint64_t needed = kBytesOfLeaf * m_map.getNumLeafNodes();
    if (needed > available)
      throw std::runtime_error(m_folder.string() + ": as a whole it needs about " +
                               strict_files::sizeText(needed) + " of memory, and " +
                               strict_files::sizeText(available) + " are left");
  }

  std::uint64_t bytesOnDisk() const {
    std::uint64_t bytes = 0;
    for (const std::string& name : namesInIndex()) {
      std::error_code missing;
      const auto size = fs::file_size(m_folder / name, missing);
      if (!missing) bytes += size;
    }
    return bytes;
  }

  std::unique_ptr<TilesOnDisk> tiles;

 private:
  bool isOfMap() const { return !m_map.isBroken() && m_map.store().tiles() == tiles.get(); }

  bool saves() const { return m_access == Access::Write || m_access == Access::Replace; }

  TileIndex open(const MapFolderOptions& options) {
    if (saves()) {
      fs::create_directories(m_folder);
      m_writer = FileLock::tryTo(m_folder / kWriterLock, FileLock::Kind::Exclusive);
      if (!m_writer)
        throw std::runtime_error(m_folder.string() + ": another process writes into this folder");
    } else {
      m_reader.emplace(m_folder / kReadersLock, FileLock::Kind::Shared);
    }
    if (m_access == Access::Read) return onlyWanted(readIndex(m_folder), options.wanted);
    if (m_access == Access::Draft) {
      fs::create_directories(m_draft);
      return readIndex(m_folder);
    }
    const bool wasSaved = isAt(m_folder);
    if (wasSaved && m_access == Access::Write) return readIndex(m_folder);
    TileIndex index;
    if (wasSaved) index.generation = readIndex(m_folder).generation;
    index.resolution = m_map.getResolution();
    index.depth = depthOfTiles(options.tileSize, index.resolution);
    index.classes = namesOf(m_map.classes());
    return index;
  }

  void takeContents() {
    SemanticOcTree leaves = loadLeaves(m_folder, tiles->index());
    if (emptyLike(leaves) != emptyLike(m_map))
      throw std::runtime_error(m_folder.string() +
                               ": its map has another resolution, other classes or parameters");
    m_map.m_store = std::make_unique<NodeStore>(leaves.store(), m_map.store().stateBytes());
    m_map.tellAll();
    tiles->addFromIndex();
    if (m_access == Access::Write) removeOthers();
  }

  std::set<std::string> namesInIndex() const {
    const TileIndex& index = tiles->index();
    std::set<std::string> names = {TileIndex::leavesName(index.generation)};
    for (const TileIndex::Tile& tile : index.tiles)
      names.insert(index.nameOf(tile.place, tile.generation));
    return names;
  }

  /** Files of before, unless somebody may still want them; and those that were never saved. */
  void removeOthers() const {
    const auto alone = FileLock::tryTo(m_folder / kReadersLock, FileLock::Kind::Exclusive);
    if (!alone) return;
    const std::set<std::string> names = namesInIndex();
    removeTiles(m_folder, names);
  }
  /** All tiles, and what else a folder has of a map, but for these. */
  static void removeTiles(const fs::path& folder, const std::set<std::string>& kept) {
    std::error_code ignored;
    for (const auto& file : fs::directory_iterator(folder, ignored)) {
      const std::string name = file.path().filename().string();
      if (TileIndex::isName(name) && kept.count(name) == 0) fs::remove(file.path(), ignored);
    }
  }
  void removeDraft() const {
    if (m_draft.empty()) return;
    removeTiles(m_draft, {});
    std::error_code ignored;
    fs::remove(m_draft, ignored);
  }

  SemanticOcTree& m_map;
  fs::path m_folder, m_draft;  ///< the latter empty: it is none
  Access m_access;
  std::optional<FileLock> m_writer, m_reader;
};

bool MapFolder::isAt(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / MapFolder::kIndexFile, ignored);
}

SemanticOcTree MapFolder::emptyMap(const fs::path& folder) {
  const FileLock lock(folder / kReadersLock, FileLock::Kind::Shared);
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
  m->tiles->bringAll();
}

std::vector<std::string> MapFolder::problems() { return m->tiles->problems(); }

MapFolder::Contents MapFolder::contents() const {
  Contents contents;
  m->tiles->addTo(contents);
  contents.tileSize = m->tiles->index().tileSize();
  contents.generation = m->tiles->index().generation;
  contents.bytesOnDisk = m->bytesOnDisk();
  return contents;
}

}  // namespace semantic_octree
