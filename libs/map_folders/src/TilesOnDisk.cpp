#include "TilesOnDisk.h"

#include <semantic_octree/store/LeafContent.h>
#include <semantic_octree/store/Scan.h>
#include <semantic_octree/store/TreeFormat.h>
#include <strict_files/Memory.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <stdexcept>

namespace semantic_octree {
namespace {

using Kind = Slot::Kind;

/** A leaf's nodes and records take 5 to 7 bytes in maps of streets. */
constexpr std::uint64_t kBytesOfLeaf = 6;

struct Count {
  long nodes = 0, inner = 0;
};

/** A tile that is away is known by its Morton code, which stands where its children come back. */
void markAway(Octant& octant, std::uint64_t code) {
  octant.slots[0].index = static_cast<std::uint32_t>(code);
  octant.slots[1].index = static_cast<std::uint32_t>(code >> 32);
}
std::uint64_t codeOfAway(const Octant& octant) {
  return std::uint64_t(octant.slots[1].index) << 32 | octant.slots[0].index;
}

long difference(std::size_t now, std::size_t before) {
  return static_cast<long>(now) - static_cast<long>(before);
}

/** Nodes below one. */
void countBelow(const NodeStore& store, const Slot& inner, Count& count) {
  if (inner.kind == Kind::Block) {
    const Block::Count block = store.block(inner).count();
    count.nodes += block.nodes;
    count.inner += block.inner;
    return;
  }
  for (const Slot& child : store.octant(inner).slots) {
    count.nodes += child.isKnown();
    count.inner += child.isInner();
    if (child.isInner()) countBelow(store, child, count);
  }
}

void addTouched(const Scan& scan, const Cube& cell, int depth, std::vector<VoxelIndex>& cubes) {
  if (!scan.pyramid().at(ScanPyramid::kTopLevel - cell.depth, indexOf(cell)).any()) return;
  if (cell.depth == depth) return cubes.push_back(indexOf(cell));
  for (int i = 0; i < 8; ++i) addTouched(scan, cell.child(i), depth, cubes);
}

}  // namespace

void MapFolder::Tiles::addFromIndex() {
  NodeStore& nodes = store();
  NodeArena& arena = nodes.arena(0);
  const auto add = [&](const auto& self, Slot& slot, const Cube& cell,
                       const TileIndex::Tile& tile) -> void {
    if (slot.isLeaf())
      throw std::runtime_error((m_folder / MapFolder::kIndexFile).string() +
                               ": altered: a tile where all is one leaf");
    if (!slot.isKnown()) {
      arena.createOctant(slot);
      slot.value = kUnknown;
    }
    slot.value = std::max(slot.value, tile.highest);
    if (cell.depth == m_index.depth) return;
    const int i = childOnTheWay(cubeAt(tile.place, m_index.depth), cell.depth + 1);
    self(self, nodes.octant(slot).slots[i], cell.child(i), tile);
  };
  for (const TileIndex::Tile& t : m_index.tiles) {
    add(add, nodes.root(), Cube(), t);
    const std::uint64_t code = tileCode(t.place);
    Tile& tile = m_tiles[code];
    tile = {t.place, t.generation, 0, true, false, t.nodes, t.innerNodes, t.checksum};
    Slot& slot = *slotOf(tile);
    slot.kind = Kind::Away;
    markAway(nodes.octant(slot), code);
    nodes.countAway(t.nodes, t.innerNodes);
  }
}

Slot* MapFolder::Tiles::slotOf(const Tile& tile) const {
  const NodeStore& nodes = store();
  Slot* slot = &store().root();
  for (int depth = 1; depth <= m_index.depth; ++depth) {
    if (slot->kind != Kind::Octant) return nullptr;
    slot = &nodes.octant(*slot).slots[childOnTheWay(cellOf(tile), depth)];
  }
  return slot->isInner() ? slot : nullptr;
}

/** A save that failed halfway has put files into the folder, too. */
std::string MapFolder::Tiles::fileOf(const Tile& tile) const {
  const std::string name = m_index.nameOf(tile.place, tile.written);
  if (!m_unsaved || tile.written <= m_index.generation) return (m_folder / name).string();
  const std::filesystem::path changed = m_unsaved->staged(name);
  const bool isPlaced = tile.isAway && !std::filesystem::exists(changed);
  return (isPlaced ? m_folder / name : changed).string();
}

/** Memory that tiles leave is taken by what comes next: so that threads, each of which has its own,
 * get their share. */
NodeArena& MapFolder::Tiles::arenaWith(bool most) {
  NodeStore& nodes = store();
  int best = 0;
  for (int i = 1; i < nodes.numArenas(); ++i) {
    const std::size_t spare = nodes.arena(i).spareBlocks(), least = nodes.arena(best).spareBlocks();
    if (most ? spare > least : spare < least) best = i;
  }
  return nodes.arena(best);
}

void MapFolder::Tiles::bring(Slot& away) {
  Tile& tile = m_tiles.at(codeOfAway(store().octant(away)));
  tile.used = ++m_clock;
  fetchIntoBudget(away, tile);
}

void MapFolder::Tiles::fetchIntoBudget(Slot& slot, Tile& tile) {
  // Others go before it comes: what they took is for it.
  makeRoom(m_clock, m_budget - std::min(m_budget, store().expectedBytes(tile.nodes)));
  fetch(slot, tile);
  makeRoom(m_clock, m_budget);
}

void MapFolder::Tiles::fetch(Slot& slot, Tile& tile) {
  read(slot, tile);
  tile.isAway = false;
  tile.halfLives.reset();
  ++m_broughtIn;
  if (!m_told) return;
  const auto place = std::lower_bound(m_order.begin(), m_order.end(), tileCode(tile.place));
  m_told(static_cast<std::size_t>(place - m_order.begin()));
}

void MapFolder::Tiles::read(Slot& slot, const Tile& tile) {
  NodeStore& nodes = store();
  NodeArena& arena = arenaWith(true);
  const std::size_t numNodes = nodes.numNodes(), numInner = nodes.numInnerNodes();
  nodes.countAway(-tile.nodes, -tile.innerNodes);
  slot.kind = Kind::Octant;
  nodes.octant(slot) = Octant();
  try {
    const std::uint32_t checksum =
        loadTile(m_map, arena, nodes.octant(slot), cellOf(tile), fileOf(tile));
    const auto expect = [&](const char* what, long found, long expected) {
      if (found != expected)
        throw std::runtime_error("cannot load map '" + fileOf(tile) +
                                 "': it is not the file that " + MapFolder::kIndexFile +
                                 " names: " + what + " " + std::to_string(found) + ", expected " +
                                 std::to_string(expected));
    };
    expect("checksum", checksum, tile.checksum);
    expect("nodes", tile.nodes + difference(nodes.numNodes(), numNodes), tile.nodes);
    expect("inner", tile.innerNodes + difference(nodes.numInnerNodes(), numInner), tile.innerNodes);
    expect("highest", nodes.highestValueBelow(slot), slot.value);
    if (NodeObserver* const observer = MapAccess::observer(m_map))
      recomputeAll(observer->worker(0), nodes, slot, cellOf(tile));
  } catch (...) {
    removeChildren(arena, slot);
    slot.kind = Kind::Away;
    markAway(nodes.octant(slot), tileCode(tile.place));
    nodes.countAway(tile.nodes, tile.innerNodes);
    throw;
  }
}

/** If memory runs out, the map is broken; the folder is what it was. */
void MapFolder::Tiles::removeChildren(NodeArena& arena, const Slot& octant) {
  try {
    for (Slot& child : store().octant(octant).slots)
      if (child.isKnown()) arena.remove(child);
  } catch (...) {
    MapAccess::setStore(m_map, nullptr);
    throw;
  }
}

void MapFolder::Tiles::prepare(const Scan& scan) {
  std::vector<VoxelIndex> cubes;
  addTouched(scan, Cube(), m_index.depth, cubes);
  ++m_clock;
  for (const VoxelIndex& cube : cubes) {
    Tile& tile = m_tiles[tileCode(cube)];
    tile.place = cube;
    tile.used = m_clock;
  }
  makeRoom(m_clock, m_budget);
  for (const VoxelIndex& cube : cubes) {
    Tile& tile = m_tiles.at(tileCode(cube));
    if (tile.isAway) fetchIntoBudget(*slotOf(tile), tile);
  }
  for (const VoxelIndex& cube : cubes) m_tiles.at(tileCode(cube)).isDirty = true;
}

void MapFolder::Tiles::changed(const Cube& cell) {
  const VoxelIndex place = indexOf(cell);
  Tile& tile = m_tiles[tileCode(place)];
  tile.place = place;
  tile.used = ++m_clock;
  tile.isDirty = true;
  makeRoom(m_clock, m_budget);
}

void MapFolder::Tiles::sendAway() { makeRoom(m_clock + 1, 0); }

void MapFolder::Tiles::makeRoom(std::uint64_t usedBefore, std::size_t budget) {
  if (store().bytes() <= budget) return;
  std::vector<Tile*> candidates;
  for (Entry& entry : m_tiles)
    if (!entry.second.isAway && entry.second.used < usedBefore) candidates.push_back(&entry.second);
  std::sort(candidates.begin(), candidates.end(), [](const Tile* a, const Tile* b) {
    return a->used != b->used ? a->used < b->used : tileCode(a->place) < tileCode(b->place);
  });
  for (Tile* tile : candidates) {
    if (store().bytes() <= budget) return;
    if (Slot* const slot = slotOf(*tile))
      send(*slot, *tile);
    else
      m_tiles.erase(tileCode(tile->place));
  }
}

void MapFolder::Tiles::send(Slot& slot, Tile& tile) {
  NodeStore& nodes = store();
  if (tile.isDirty) write(slot, tile);
  Count count;
  countBelow(nodes, slot, count);
  if (m_map.classes().hasHalfLives())
    tile.halfLives = halfLivesBelow(nodes, slot, m_map.numClasses());
  removeChildren(arenaWith(false), slot);
  slot.kind = Kind::Away;
  markAway(nodes.octant(slot), tileCode(tile.place));
  tile.isAway = true;
  tile.nodes = count.nodes;
  tile.innerNodes = count.inner;
  nodes.countAway(count.nodes, count.inner);
  ++m_sentOut;
}

void MapFolder::Tiles::write(const Slot& slot, Tile& tile) {
  Count count;
  countBelow(store(), slot, count);
  Tile next = tile;
  next.written = m_next;
  tile.checksum =
      saveTile(m_map, slot, cellOf(tile), static_cast<std::uint64_t>(count.nodes), fileOf(next));
  tile.written = next.written;
  tile.isDirty = false;
}

TileIndex MapFolder::Tiles::writeChanged() {
  TileIndex index = m_index;
  index.generation = m_next;
  index.tiles.clear();
  for (auto it = m_tiles.begin(); it != m_tiles.end();) {
    Tile& tile = it->second;
    const Slot* const slot = slotOf(tile);
    if (!slot) {
      it = m_tiles.erase(it);
      continue;
    }
    if (tile.isDirty) write(*slot, tile);
    Count count{tile.nodes, tile.innerNodes};
    if (!tile.isAway) countBelow(store(), *slot, count = Count());
    index.tiles.push_back(
        {tile.place, tile.written, count.nodes, count.inner, slot->value, tile.checksum});
    ++it;
  }
  std::sort(index.tiles.begin(), index.tiles.end(),
            [](const auto& a, const auto& b) { return tileCode(a.place) < tileCode(b.place); });
  return index;
}

bool MapFolder::Tiles::mayHold(const Slot& away, const ClassSet& classes) const {
  const auto& halfLives = m_tiles.at(codeOfAway(store().octant(away))).halfLives;
  return !halfLives || (*halfLives & classes).any();
}

void MapFolder::Tiles::checkFits(std::optional<std::size_t> most) const {
  const std::uint64_t available = most.value_or(strict_files::availableMemory());
  const std::uint64_t needed = kBytesOfLeaf * m_map.getNumLeafNodes();
  if (needed > available)
    throw std::runtime_error(m_folder.string() + ": as a whole it needs about " +
                             strict_files::sizeText(needed) + " of memory, and " +
                             strict_files::sizeText(available) + " are left");
}

std::vector<std::uint64_t> MapFolder::Tiles::sortedCodes() const {
  std::vector<std::uint64_t> codes;
  for (const Entry& entry : m_tiles) codes.push_back(entry.first);
  std::sort(codes.begin(), codes.end());
  return codes;
}

void MapFolder::Tiles::onTile(std::function<void(std::size_t)> told) {
  m_told = std::move(told);
  m_order = sortedCodes();
}

void MapFolder::Tiles::bringAll() {
  for (const std::uint64_t code : sortedCodes()) {
    Tile& tile = m_tiles.at(code);
    if (tile.isAway) fetch(*slotOf(tile), tile);
  }
}

std::vector<std::string> MapFolder::Tiles::problems() {
  std::vector<std::string> problems;
  for (const std::uint64_t code : sortedCodes()) {
    const auto tile = m_tiles.find(code);
    if (tile == m_tiles.end() || !tile->second.isAway) continue;
    try {
      bring(*slotOf(tile->second));
    } catch (const std::runtime_error& e) {
      problems.push_back(e.what());
    }
  }
  return problems;
}

MapFolder::Contents MapFolder::Tiles::contents() const {
  Contents contents;
  for (const Entry& entry : m_tiles) {
    const bool exists = slotOf(entry.second) != nullptr;
    contents.tiles += exists;
    contents.tilesInMemory += exists && !entry.second.isAway;
  }
  contents.tileSize = m_index.tileSize();
  contents.generation = m_index.generation;
  for (const std::string& name : m_index.files()) {
    std::error_code missing;
    const auto size = std::filesystem::file_size(m_folder / name, missing);
    if (!missing) contents.bytesOnDisk += size;
  }
  contents.broughtIn = m_broughtIn;
  contents.sentOut = m_sentOut;
  return contents;
}

}  // namespace semantic_octree
