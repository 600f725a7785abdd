#include "ScanMerger.h"

#include <semantic_octree/store/BlockUpdate.h>

#include "Parallel.h"

namespace semantic_octree {
namespace {

/** Threads share cubes of 64 voxels' side. */
constexpr int kSharedDepth = 10;

/** Calls f(i, cell) for the children of a cube that the scan touched. */
template <typename F>
void forEachTouchedChild(const Scan& scan, const ScanCube& cube, F f) {
  for (int i = 0; i < 8; ++i) {
    const Cube cell = cube.cell.child(i);
    if (scan.pyramid().at(cube.level() - 1, indexOf(cell)).any()) f(i, cell);
  }
}

std::unique_ptr<const FusionRule> ruleFor(const MergeTarget& target, const Scan& scan) {
  if (target.rule) return target.rule->trusting(scan.labels());
  return std::make_unique<FilterRule<ClassFilter<float>>>(target.filter.trusting(scan.labels()));
}

}  // namespace

bool ScanMerger::merge(const ScanCube& cube) {
  const CubeContent content = cube.content(m_scan);
  const Whole whole = updateWhole(*cube.slot, content.allFree(), content.hit());
  if (whole != Whole::Descend) return m_nodes.note(cube.cell, whole == Whole::Changed);
  if (cube.level() == 0) return m_nodes.note(cube.cell, mergeTile(cube));
  Octant& octant = childrenOf(*cube.slot);
  bool changed = false;
  forEachTouchedChild(m_scan, cube, [&](int i, const Cube& cell) {
    changed |= merge({&octant.slots[i], cell});
  });
  return m_nodes.finish(*cube.slot, cube.cell, changed, false);
}

ScanMerger::Whole ScanMerger::updateWhole(Slot& slot, bool allFree, bool anyHit) {
  if (anyHit || !m_nodes.pruning || slot.isInner()) return Whole::Descend;
  if (slot.kind == Slot::Kind::Leaf && slot.value <= m_lowest)
    return Whole::Unchanged;  // free for certain, and seen free once more
  if (!allFree) return Whole::Descend;
  const bool isNew = !slot.isKnown();
  if (isNew) m_nodes.arena.createLeaf(slot, 0);
  return m_voxels->miss(slot) || isNew ? Whole::Changed : Whole::Unchanged;
}

Octant& ScanMerger::childrenOf(Slot& slot) {
  if (slot.isInner()) return m_nodes.store.octant(slot);
  return slot.isKnown() ? m_nodes.arena.expandToOctant(slot) : m_nodes.arena.createOctant(slot);
}

bool ScanMerger::mergeTile(const ScanCube& cube) {
  const Scan::Tile tile = m_scan.tile(indexOf(cube.cell));
  const auto blockScan = [&](int i) {
    return BlockScan{tile.free[i], tile.hit.words[i], m_scan.votes(), tile.hit.ranks[i]};
  };
  Octant& octant = childrenOf(*cube.slot);
  for (const Slot& slot : octant.slots) m_nodes.store.prefetchInner(slot);
  bool changed = false;
  for (int i = 0; i < 8; ++i)
    if (blockScan(i).touched())
      changed |= mergeBlock({&octant.slots[i], cube.cell.child(i)}, blockScan(i));
  return m_nodes.finish(*cube.slot, cube.cell, changed, false);
}

bool ScanMerger::mergeBlock(const ScanCube& cube, const BlockScan& scan) {
  Slot& slot = *cube.slot;
  const Whole whole = updateWhole(slot, !~scan.free, scan.hit);
  if (whole != Whole::Descend) return whole == Whole::Changed;
  const bool wasInner = slot.isInner();
  Block& block = wasInner         ? m_nodes.store.block(slot)
                 : slot.isKnown() ? m_nodes.arena.expandToBlock(slot)
                                  : m_nodes.arena.createBlock(slot);
  const auto result = m_voxels->update(block, scan);
  return m_nodes.finish(slot, cube.cell, result.changed || !wasInner, result.reshaped || !wasInner);
}

void ScanMerger::collect(const ScanCube& cube, std::vector<ScanCube>& parts) {
  if (cube.cell.depth == kSharedDepth) return parts.push_back(cube);
  Octant& octant = childrenOf(*cube.slot);
  forEachTouchedChild(m_scan, cube, [&](int i, const Cube& cell) {
    collect({&octant.slots[i], cell}, parts);
  });
}

bool ScanMerger::finishAbove(const ScanCube& cube, const std::vector<char>& changed,
                             std::size_t& next) {
  if (cube.cell.depth == kSharedDepth) return changed[next++];
  Octant& octant = m_nodes.store.octant(*cube.slot);
  bool anyChanged = false;
  forEachTouchedChild(m_scan, cube, [&](int i, const Cube& cell) {
    anyChanged |= finishAbove({&octant.slots[i], cell}, changed, next);
  });
  return m_nodes.finish(*cube.slot, cube.cell, anyChanged, false);
}

void mergeScan(const MergeTarget& target, const Scan& scan, int threads) {
  const auto rule = ruleFor(target, scan);
  std::deque<ScanMerger> mergers;
  for (int i = 0; i < threads; ++i) mergers.emplace_back(target, *rule, scan, i);
  const ScanCube whole{&target.store.root(), Cube()};
  std::vector<ScanCube> parts;
  mergers[0].collect(whole, parts);

  std::vector<char> changed(parts.size());
  shareOut(threads, parts.size(),
           [&](int thread, std::size_t i) { changed[i] = mergers[thread].merge(parts[i]); });

  for (ScanMerger& merger : mergers) merger.m_nodes.tellNoted();
  std::size_t next = 0;
  mergers[0].finishAbove(whole, changed, next);
}

}  // namespace semantic_octree
