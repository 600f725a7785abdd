#include <map_correction/KeyframeMap.h>

#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/NodeEditor.h>
#include <semantic_octree/store/TileCodes.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "PackedScan.h"

namespace semantic_octree {
namespace {

/** Makes some tiles of a tree what they are in another tree, as an insertion would. Nodes are
 * pruned, inner nodes' bookkeeping follows, and changes are told to followers. Both trees are
 * pruned, or both are not. */
class TileReplacement {
 public:
  TileReplacement(const MergeTarget& target, const NodeStore& source)
      : m_nodes(target, 0), m_store(target.store), m_source(source) {}

  void replace(const TileCodes& tiles) {
    replace(m_store.root(), Cube(), {tiles.begin(), tiles.end()}, m_source.root());
    m_nodes.tellNoted();
  }

 private:
  bool isSame(const Slot& slot, const Slot& source) const {
    return areSame(m_store, slot, m_source, source, nullptr);
  }

  /** \param tiles those below the node \param source the other tree's node there; a leaf stands for
   * all that is below \return whether anything changed */
  bool replace(Slot& slot, const Cube& cell, const TileRange& tiles, const Slot& source) {
    m_store.bring(slot);
    const bool changed = cell.depth == kTileDepth
                             ? m_nodes.note(cell, replaceAll(slot, cell, source))
                             : replaceBelow(slot, cell, tiles, source);
    if (changed) m_store.tellChanged(slot, cell);
    return changed;
  }

  bool replaceBelow(Slot& slot, const Cube& cell, const TileRange& tiles, const Slot& source) {
    if (!slot.isInner() && !source.isInner() && isSame(slot, source)) return false;
    Octant& octant = slot.isInner()   ? m_store.octant(slot)
                     : slot.isKnown() ? m_nodes.arena.expandToOctant(slot)
                                      : m_nodes.arena.createOctant(slot);
    bool changed = false;
    for (int i = 0; i < 8; ++i) {
      const TileRange below = tiles.below(cell.depth, i);
      const Slot& child = source.isInner() ? m_source.octant(source).slots[i] : source;
      if (!below.empty()) changed |= replace(octant.slots[i], cell.child(i), below, child);
    }
    return finish(slot, cell, changed);
  }

  bool finish(Slot& slot, const Cube& cell, bool changed) {
    const Octant& octant = m_store.octant(slot);
    const bool isEmpty = std::none_of(octant.slots, octant.slots + 8,
                                      [](const Slot& child) { return child.isKnown(); });
    if (isEmpty && !changed) {  // it was made in vain
      m_nodes.arena.remove(slot);
      return false;
    }
    return m_nodes.finish(slot, cell, changed, true);
  }

  /** A tile, or a node below. What is alike stays where it is. What is replaced knows nothing of
   * what was told of the node before: it counts as reshaped. */
  bool replaceAll(Slot& slot, const Cube& cell, const Slot& source) {
    if (isSame(slot, source)) return false;
    if (slot.kind != Slot::Kind::Octant || source.kind != Slot::Kind::Octant) {
      if (slot.isKnown()) m_nodes.arena.remove(slot);
      copy(slot, cell, source);
      return true;
    }
    for (int i = 0; i < 8; ++i)
      replaceAll(m_store.octant(slot).slots[i], cell.child(i), m_source.octant(source).slots[i]);
    slot.value = source.value;
    m_nodes.recompute(slot, cell, true);
    return true;
  }

  void copy(Slot& unknown, const Cube& cell, const Slot& source) {
    if (source.isLeaf()) {
      m_nodes.arena.createLeaf(unknown, source.value);
      if (source.kind == Slot::Kind::LeafWithRecord)
        m_nodes.arena.setRecord(unknown, m_source.record(source));
    } else if (source.kind == Slot::Kind::Octant) {
      Octant& octant = m_nodes.arena.createOctant(unknown);
      for (int i = 0; i < 8; ++i)
        copy(octant.slots[i], cell.child(i), m_source.octant(source).slots[i]);
    } else if (source.kind == Slot::Kind::Block) {
      m_nodes.arena.createBlock(unknown, m_source.contentOf(m_source.block(source)));
    }
    unknown.value = source.value;
    if (unknown.isInner()) m_nodes.recompute(unknown, cell, true);
  }

  NodeEditor m_nodes;
  NodeStore& m_store;
  const NodeStore& m_source;
};

}  // namespace

struct KeyframeMap::Content {
  /** What a scan saw. The box tells, without reading it, where that can be. */
  struct StoredVoxels {
    ScanStorage::Piece packed;
    TileBox box;
  };
  struct StoredScan {
    KeyframeId keyframe;
    Eigen::Isometry3d T_keyframe_sensor;
    InsertionOptions options;
    std::int64_t time;  ///< of the map's clock
    ScanStorage::Piece cloud;
    StoredVoxels voxels;
  };

  Content(SemanticOcTree& tree, const std::filesystem::path& folder) : map(tree), storage(folder) {
    if (!map.empty()) throw std::invalid_argument("keyframes: their map is not empty at first");
  }

  Eigen::Isometry3d& T_map_keyframe(KeyframeId id) {
    const auto at = keyframes.find(id);
    if (at != keyframes.end()) return at->second;
    throw std::out_of_range("keyframes: there is no keyframe " + std::to_string(id));
  }
  void trace(const StoredScan& s, const LabeledCloud& cloud, const Eigen::Isometry3d& T,
             Scan& scan) const {
    scan.set(cloud, T * s.T_keyframe_sensor, map.getResolution(), MapAccess::filter(map),
             s.options);
  }
  StoredVoxels keep(const PackedScan& voxels) {
    return {storage.keep(voxels.bytes()), TileBox(tilesOf(voxels))};
  }
  /** Calls f with a scan for it to fill; what fails half-filled must not leak into the next. */
  template <typename F>
  void inBuffers(const F& f) {
    if (!buffers) buffers = std::make_unique<Scan>();
    try {
      f(*buffers);
    } catch (...) {
      buffers = nullptr;
      throw;
    }
    if (buffers->isLarge())
      buffers = nullptr;
    else if (buffers->hasVoxels())
      buffers->clear();
  }

  SemanticOcTree& map;
  ScanStorage storage;
  std::map<KeyframeId, Eigen::Isometry3d> keyframes;  ///< T_map_keyframe of those that are left
  KeyframeId next = 0;
  std::deque<StoredScan> scans;  ///< in the order of their insertion
  std::unique_ptr<Scan> buffers;
};

/** One correction, until it is done. */
class KeyframeMap::Correction {
 public:
  explicit Correction(Content& content) : m(content), m_voxels(content.scans.size()) {}
  /** Drops what was prepared, if it does not come to pass. */
  ~Correction() {
    for (auto& voxels : m_voxels)
      if (voxels) m.storage.drop(voxels->packed);
  }

  /** The scan is to be as if its keyframe were there. */
  void move(std::size_t scan, const Eigen::Isometry3d& T_map_keyframe) {
    const auto& s = m.scans[scan];
    const PackedScan before(m.storage.load(s.voxels.packed));
    const LabeledCloud cloud = unpackCloud(m.storage.load(s.cloud));
    m.inBuffers([&](Scan& traced) {
      m.trace(s, cloud, T_map_keyframe, traced);
      const PackedScan after = packed(traced);
      addTiles(differingTiles(before, after));
      m_voxels[scan] = m.keep(after);
    });
  }
  /** The scan is to be as if it had seen nothing. */
  void remove(std::size_t scan) {
    addTiles(tilesOf(PackedScan(m.storage.load(m.scans[scan].voxels.packed))));
    m_voxels[scan] = m.keep(PackedScan(false, {}));
  }

  /** Puts it into the map. */
  void apply() {
    if (m_tiles.empty()) return accept();
    const std::vector<TileCodes> parts = partsOf(m_tiles);
    SemanticOcTree anew = madeAnew(parts.front());
    MapAccess::change(m.map, [&](const MergeTarget& target) {
      for (const TileCodes& part : parts) {
        if (&part != &parts.front()) anew = madeAnew(part);
        TileReplacement(target, MapAccess::store(anew)).replace(part);
      }
    });
    accept();
  }

 private:
  void addTiles(const TileCodes& tiles) {
    TileCodes all;
    all.reserve(m_tiles.size() + tiles.size());
    std::set_union(m_tiles.begin(), m_tiles.end(), tiles.begin(), tiles.end(),
                   std::back_inserter(all));
    m_tiles.swap(all);
  }

  /** Voxels of a scan after the move. */
  const Content::StoredVoxels& voxelsOf(std::size_t scan) const {
    return m_voxels[scan] ? *m_voxels[scan] : m.scans[scan].voxels;
  }
  /** Parts to be made anew: one of a folder's tiles at a time; without a folder all at once. */
  std::vector<TileCodes> partsOf(const TileCodes& tiles) const {
    const TileSource* const folder = MapAccess::store(m.map).tiles();
    if (!folder) return {tiles};
    const int shift = 3 * (kTileDepth - folder->depth());
    std::vector<TileCodes> parts;
    for (const std::uint64_t code : tiles) {
      if (parts.empty() || parts.back().back() >> shift != code >> shift) parts.emplace_back();
      parts.back().push_back(code);
    }
    return parts;
  }
  /** Some tiles, from what all scans saw in them. */
  SemanticOcTree madeAnew(const TileCodes& tiles) {
    SemanticOcTree anew = emptyLike(m.map);
    MapAccess::setClock(anew, 0);
    const TileBox box(tiles);
    for (std::size_t i = 0; i < m.scans.size(); ++i) {
      MapAccess::ageUntil(anew, m.scans[i].time);
      if (voxelsOf(i).box.meets(box)) merge(i, tiles, anew);
    }
    MapAccess::ageUntil(anew, MapAccess::clock(m.map));
    return anew;
  }
  void merge(std::size_t i, const TileCodes& tiles, SemanticOcTree& anew) {
    const InsertionOptions& options = m.scans[i].options;
    const PackedScan voxels(m.storage.load(voxelsOf(i).packed));
    m.inBuffers([&](Scan& scan) {
      unpack(voxels, tiles, m.map.numClasses(), options, scan);
      MapAccess::merge(anew, scan, options.threads);
    });
  }

  void accept() {
    for (std::size_t i = 0; i < m_voxels.size(); ++i)
      if (m_voxels[i]) std::swap(m.scans[i].voxels, *m_voxels[i]);
  }

  Content& m;
  std::vector<std::optional<Content::StoredVoxels>> m_voxels;  ///< of scans that change
  TileCodes m_tiles;                                           ///< to be made anew
};

KeyframeMap::KeyframeMap(SemanticOcTree& map, const std::filesystem::path& folder)
    : m(std::make_unique<Content>(map, folder)) {}

KeyframeMap::~KeyframeMap() = default;

KeyframeId KeyframeMap::begin(const Eigen::Isometry3d& T_map_keyframe) {
  m->keyframes.emplace(m->next, T_map_keyframe);
  return m->next++;
}

InsertionReport KeyframeMap::insert(const LabeledCloud& cloud,
                                    const Eigen::Isometry3d& T_keyframe_sensor,
                                    const InsertionOptions& options, double secondsSince) {
  options.validate();
  const std::int64_t time = MapAccess::timeIn(m->map, secondsSince);
  if (m->keyframes.empty() || m->keyframes.rbegin()->first + 1 != m->next)
    throw std::logic_error("keyframes: a scan is inserted before a keyframe has begun");
  Content::StoredScan stored{m->next - 1, T_keyframe_sensor, options, time, {}, {}};
  InsertionReport report;
  m->inBuffers([&](Scan& scan) {
    m->trace(stored, cloud, m->T_map_keyframe(stored.keyframe), scan);
    stored.cloud = m->storage.keep(packCloud(cloud));
    stored.voxels = m->keep(packed(scan));
    m->scans.push_back(std::move(stored));
    try {
      MapAccess::ageUntil(m->map, time);
      MapAccess::merge(m->map, scan, options.threads);
    } catch (...) {
      m->scans.pop_back();
      throw;
    }
    report = scan.report();
  });
  return report;
}

void KeyframeMap::move(const std::vector<KeyframePose>& poses) {
  std::map<KeyframeId, Eigen::Isometry3d> newPoses;
  for (const KeyframePose& p : poses)
    if (m->T_map_keyframe(p.keyframe).matrix() != p.T_map_keyframe.matrix())
      newPoses[p.keyframe] = p.T_map_keyframe;
    else
      newPoses.erase(p.keyframe);
  Correction correction(*m);
  for (std::size_t i = 0; i < m->scans.size(); ++i)
    if (const auto at = newPoses.find(m->scans[i].keyframe); at != newPoses.end())
      correction.move(i, at->second);
  correction.apply();
  for (const auto& [id, T_map_keyframe] : newPoses) m->keyframes[id] = T_map_keyframe;
}

void KeyframeMap::remove(const std::set<KeyframeId>& keyframes) {
  for (const KeyframeId id : keyframes) m->T_map_keyframe(id);
  Correction correction(*m);
  const auto isGone = [&](const auto& s) { return keyframes.count(s.keyframe) > 0; };
  for (std::size_t i = 0; i < m->scans.size(); ++i)
    if (isGone(m->scans[i])) correction.remove(i);
  correction.apply();
  for (const KeyframeId id : keyframes) m->keyframes.erase(id);
  for (auto& s : m->scans)
    if (isGone(s)) {
      m->storage.drop(s.cloud);
      m->storage.drop(s.voxels.packed);
    }
  m->scans.erase(std::remove_if(m->scans.begin(), m->scans.end(), isGone), m->scans.end());
}

std::size_t KeyframeMap::numScans() const { return m->scans.size(); }

const Eigen::Isometry3d& KeyframeMap::pose(KeyframeId keyframe) const {
  return m->T_map_keyframe(keyframe);
}

}  // namespace semantic_octree
