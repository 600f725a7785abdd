#include <semantic_octree/store/FusionRule.h>
#include <semantic_octree/store/MapAccess.h>
#include <semantic_octree/store/Scan.h>

#include <memory>
#include <vector>

#include "Parallel.h"

namespace semantic_octree {
namespace {

/** Threads share cubes of 64 voxels' side. */
constexpr int kSharedDepth = 10;

/** Fusion by the target's rule, or else by its filter. */
std::unique_ptr<BlockFusion> fusionOf(const MergeTarget& target, NodeArena& arena,
                                      const LabelReliability& labels) {
  if (target.rule) return target.rule->begin(target.store, arena, target.pruning, labels);
  return fusionBy(target.filter.trusting(labels), target.store, arena, target.pruning);
}

/** A cube of the scan (see ScanPyramid) and the tree's node for it. */
struct ScanCube {
  Slot* slot;
  Cube cell;

  int level() const { return ScanPyramid::kTopLevel - cell.depth; }
};

/** Carries a scan's voxels into a subtree, in one thread.
 *
 * The tree is descended once per tile of 8 x 8 x 8 voxels. On the way up each inner node above a
 * change is pruned or recomputed once. A leaf of the tree that the scan saw free as a whole gets
 * one update, with the values of single voxels' updates and pruning. */
class ScanMerger {
 public:
  /** \param thread number of the thread that it works in */
  ScanMerger(const MergeTarget& target, const Scan& scan, int thread)
      : m_nodes(target, thread),
        m_scan(scan),
        m_voxels(fusionOf(target, m_nodes.arena, scan.labels())),
        m_lowest(m_voxels->lowest()) {}

  /** The cubes that threads share, and that the scan touched; nodes above them are made. */
  void collect(const ScanCube& cube, std::vector<ScanCube>& parts) {
    if (cube.cell.depth == kSharedDepth) return parts.push_back(cube);
    forEachTouchedChild(cube, childrenOf(*cube.slot),
                        [&](const ScanCube& child) { collect(child, parts); });
  }

  /** \return whether anything changed */
  bool merge(const ScanCube& cube) {
    const CubeContent content = m_scan.pyramid().at(cube.level(), indexOf(cube.cell));
    const Whole whole = updateWhole(*cube.slot, content.allFree(), content.hit());
    if (whole != Whole::Descend) return m_nodes.note(cube.cell, whole == Whole::Changed);
    if (cube.level() == 0) return m_nodes.note(cube.cell, mergeTile(cube));
    bool changed = false;
    forEachTouchedChild(cube, childrenOf(*cube.slot),
                        [&](const ScanCube& child) { changed |= merge(child); });
    return m_nodes.finish(*cube.slot, cube.cell, changed, false);
  }

  void tellNoted() { m_nodes.tellNoted(); }

  /** Finishes the nodes above what was collected. \param changed of each; `next` is the first one
   * below the cube, and then the first one behind it */
  bool finishAbove(const ScanCube& cube, const std::vector<char>& changed, std::size_t& next) {
    if (cube.cell.depth == kSharedDepth) return changed[next++];
    bool anyChanged = false;
    forEachTouchedChild(cube, m_nodes.store.octant(*cube.slot), [&](const ScanCube& child) {
      anyChanged |= finishAbove(child, changed, next);
    });
    return m_nodes.finish(*cube.slot, cube.cell, anyChanged, false);
  }

 private:
  enum class Whole { Unchanged, Changed, Descend };

  template <typename F>
  void forEachTouchedChild(const ScanCube& cube, Octant& octant, const F& f) const {
    for (int i = 0; i < 8; ++i) {
      const Cube cell = cube.cell.child(i);
      if (m_scan.pyramid().at(cube.level() - 1, indexOf(cell)).any()) f({&octant.slots[i], cell});
    }
  }

  Whole updateWhole(Slot& slot, bool allFree, bool anyHit) {
    if (anyHit || !m_nodes.pruning || slot.isInner()) return Whole::Descend;
    if (slot.kind == Slot::Kind::Leaf && slot.value <= m_lowest)
      return Whole::Unchanged;  // free for certain, and seen free once more
    if (!allFree) return Whole::Descend;
    const bool isNew = !slot.isKnown();
    if (isNew) m_nodes.arena.createLeaf(slot, 0);
    return m_voxels->miss(slot) || isNew ? Whole::Changed : Whole::Unchanged;
  }

  Octant& childrenOf(Slot& slot) {
    if (slot.isInner()) return m_nodes.store.octant(slot);
    return slot.isKnown() ? m_nodes.arena.expandToOctant(slot) : m_nodes.arena.createOctant(slot);
  }

  bool mergeTile(const ScanCube& cube) {
    const Scan::Tile tile = m_scan.tile(indexOf(cube.cell));
    Octant& octant = childrenOf(*cube.slot);
    for (const Slot& slot : octant.slots) m_nodes.store.prefetchInner(slot);
    bool changed = false;
    for (int i = 0; i < 8; ++i) {
      const BlockScan scan{tile.free[i], tile.hit.words[i], m_scan.votes(), tile.hit.ranks[i]};
      if (scan.touched()) changed |= mergeBlock({&octant.slots[i], cube.cell.child(i)}, scan);
    }
    return m_nodes.finish(*cube.slot, cube.cell, changed, false);
  }

  bool mergeBlock(const ScanCube& cube, const BlockScan& scan) {
    Slot& slot = *cube.slot;
    const Whole whole = updateWhole(slot, !~scan.free, scan.hit);
    if (whole != Whole::Descend) return whole == Whole::Changed;
    const bool isNew = !slot.isInner();
    Block& block = !isNew           ? m_nodes.store.block(slot)
                   : slot.isKnown() ? m_nodes.arena.expandToBlock(slot)
                                    : m_nodes.arena.createBlock(slot);
    const auto result = m_voxels->update(block, scan);
    return m_nodes.finish(slot, cube.cell, result.changed || isNew, result.reshaped || isNew);
  }

  NodeEditor m_nodes;
  const Scan& m_scan;
  std::unique_ptr<BlockFusion> m_voxels;
  Units m_lowest;  ///< see BlockFusion
};

/** Merges a scan into the whole tree. The threads share the cubes of one level, then the nodes
 * above are finished. The result does not depend on the number of threads. */
void mergeScan(const MergeTarget& target, const Scan& scan, int threads) {
  std::deque<ScanMerger> mergers;
  for (int i = 0; i < threads; ++i) mergers.emplace_back(target, scan, i);
  const ScanCube whole{&target.store.root(), Cube()};
  std::vector<ScanCube> parts;
  mergers[0].collect(whole, parts);

  std::vector<char> changed(parts.size());
  shareOut(threads, parts.size(),
           [&](int thread, std::size_t i) { changed[i] = mergers[thread].merge(parts[i]); });

  for (ScanMerger& merger : mergers) merger.tellNoted();
  std::size_t next = 0;
  mergers[0].finishAbove(whole, changed, next);
}

}  // namespace

void MapAccess::merge(SemanticOcTree& map, const Scan& scan, int threads) {
  if (!scan.hasVoxels()) return;
  checkMayChange(map);
  if (store(map).tiles()) store(map).tiles()->prepare(scan);
  change(map, [&](const MergeTarget& target) { mergeScan(target, scan, threads); });
}

}  // namespace semantic_octree
