#include "ScanMerger.h"

#include <atomic>
#include <thread>

namespace semantic_octree {
namespace {

/** Threads share cubes of 64 voxels' side. */
constexpr int kSharedDepth = 10;

/** Calls f(i, cell) for the children of a cube that the scan touched. */
template <typename F>
void forEachTouchedChild(const Scan& scan, const ScanCube& cube, F f) {
  for (int i = 0; i < 8; ++i) {
    const Cell cell = cube.cell.child(i);
    if (scan.pyramid().at(cube.level() - 1, cell.index).any()) f(i, cell);
  }
}

}  // namespace

bool ScanMerger::merge(const ScanCube& cube) {
  const CubeContent content = cube.content(m_scan);
  const Whole whole = updateWhole(*cube.node, cube.isNew, content.allFree(), content.hit());
  if (whole != Whole::Descend) return note(cube.cell, whole == Whole::Changed);
  if (cube.level() == 0) return note(cube.cell, mergeTile(cube));
  Octant& octant = childrenOf(*cube.node, cube.isNew);
  bool changed = false;
  forEachTouchedChild(m_scan, cube, [&](int i, const Cell& cell) {
    const bool isNew = !octant.has(i);
    changed |= merge({&m_arena.createChild(octant, i), isNew, cell});
  });
  return finish(*cube.node, cube.cell, changed);
}

bool ScanMerger::note(const Cell& cube, bool changed) {
  if (changed && m_target.touched) m_changed.push_back(cube);
  return changed;
}

ScanMerger::Whole ScanMerger::updateWhole(Node& node, bool isNew, bool allFree, bool anyHit) {
  if (anyHit || !m_target.pruning || (!isNew && !node.isLeaf())) return Whole::Descend;
  if (!isNew && !node.hasClassRecord() && node.getValue() <= m_filter.lowestOccupancy())
    return Whole::Unchanged;  // free for certain, and seen free once more
  if (!allFree) return Whole::Descend;
  return miss(node) || isNew ? Whole::Changed : Whole::Unchanged;
}

Octant& ScanMerger::childrenOf(Node& node, bool isNew) {
  if (!node.isLeaf()) return m_store.octant(node);
  return isNew ? m_arena.createOctant(node) : m_arena.expand(node);
}

bool ScanMerger::finish(Node& node, const Cell& cell, bool changed) {
  if (m_target.pruning && m_arena.prune(node)) return changed;
  if (!changed) return false;
  m_store.updateOccupancy(node);
  if (m_gTree) m_gTree->recompute(m_store, node, cell);
  return true;
}

bool ScanMerger::mergeTile(const ScanCube& cube) {
  const std::size_t tile = m_scan.pyramid().tileIndex(cube.cell.index);
  const std::uint64_t *free = m_scan.freeBits(tile), *hit = m_scan.hitBits(tile);
  m_nextHit = m_scan.firstHit(tile);
  Octant& octant = childrenOf(*cube.node, cube.isNew);
  bool changed = false;
  for (int i = 0; i < 8; ++i) {
    if (!(free[i] | hit[i])) continue;
    const bool isNew = !octant.has(i);
    changed |=
        mergeWord({&m_arena.createChild(octant, i), isNew, cube.cell.child(i)}, free[i], hit[i]);
  }
  return finish(*cube.node, cube.cell, changed);
}

bool ScanMerger::mergeWord(const ScanCube& cube, std::uint64_t free, std::uint64_t hit) {
  const Whole whole = updateWhole(*cube.node, cube.isNew, !~free, hit);
  if (whole != Whole::Descend) return whole == Whole::Changed;
  Octant& octant = childrenOf(*cube.node, cube.isNew);
  bool changed = false;
  for (int i = 0; i < 8; ++i, free >>= 8, hit >>= 8) {
    if (!((free | hit) & 0xff)) continue;
    const bool isNew = !octant.has(i);
    changed |= mergeByte({&m_arena.createChild(octant, i), isNew, cube.cell.child(i)}, free & 0xff,
                         hit & 0xff);
  }
  return finish(*cube.node, cube.cell, changed);
}

bool ScanMerger::mergeByte(const ScanCube& cube, unsigned free, unsigned hit) {
  const Whole whole = updateWhole(*cube.node, cube.isNew, free == 0xff, hit);
  if (whole != Whole::Descend) return whole == Whole::Changed;
  Octant& octant = childrenOf(*cube.node, cube.isNew);
  bool changed = false;
  for (unsigned voxels = free | hit; voxels; voxels &= voxels - 1) {
    const int i = __builtin_ctz(voxels);
    changed |= !octant.has(i);
    Node& voxel = m_arena.createChild(octant, i);
    changed |= hit >> i & 1 ? this->hit(voxel) : miss(voxel);
  }
  return finish(*cube.node, cube.cell, changed);
}

bool ScanMerger::hit(Node& leaf) {
  const std::uint32_t rank = m_nextHit++;
  return hit(leaf, m_scan.votes().softLabelOf(rank), m_scan.votes().votesOf(rank));
}

bool ScanMerger::hit(Node& leaf, const float* softLabel, const HitVotes::Result& hard) {
  const float before = leaf.getValue();
  if (!softLabel && hard.numVoted == 0 && !leaf.hasClassRecord()) {
    leaf.setValue(m_filter.occupancyAfterUnlabeledHit(before));
    return leaf.getValue() != before;
  }
  Belief belief = leaf.hasClassRecord() ? m_store.record(leaf) : m_filter.uniform(before);
  const Belief old = belief;
  if (softLabel)
    m_filter.hit(belief, softLabel);
  else if (hard.numVoted > 0)
    m_filter.hit(belief, hard.votes, hard.numVoted);
  else
    m_filter.hit(belief);
  if (leaf.hasClassRecord() && belief == old) return false;
  m_arena.setRecord(leaf, belief);
  leaf.setValue(belief.occupancyLogOdds(m_filter.numClasses()));
  return true;
}

bool ScanMerger::miss(Node& leaf) {
  if (!leaf.hasClassRecord()) {
    const float before = leaf.getValue();
    leaf.setValue(m_filter.occupancyAfterMiss(before));
    return leaf.getValue() != before;
  }
  Belief& belief = m_store.record(leaf);
  m_filter.miss(belief);
  const float uniform = m_filter.occupancyOfUniform(belief.rest);
  if (belief.isUniform() && uniform <= m_filter.lowestOccupancy()) {
    leaf.setValue(uniform);  // free for certain: the record says no more than the occupancy does
    m_arena.dropRecord(leaf);
  } else {
    leaf.setValue(belief.occupancyLogOdds(m_filter.numClasses()));
  }
  return true;
}

void ScanMerger::collect(const ScanCube& cube, std::vector<ScanCube>& parts) {
  if (cube.cell.depth == kSharedDepth) return parts.push_back(cube);
  Octant& octant = childrenOf(*cube.node, cube.isNew);
  forEachTouchedChild(m_scan, cube, [&](int i, const Cell& cell) {
    const bool isNew = !octant.has(i);
    collect({&m_arena.createChild(octant, i), isNew, cell}, parts);
  });
}

bool ScanMerger::finishAbove(const ScanCube& cube, const std::vector<char>& changed,
                             std::size_t& next) {
  if (cube.cell.depth == kSharedDepth) return changed[next++];
  Octant& octant = m_store.octant(*cube.node);
  bool anyChanged = false;
  forEachTouchedChild(m_scan, cube, [&](int i, const Cell& cell) {
    anyChanged |= finishAbove({&octant.nodes[i], false, cell}, changed, next);
  });
  return finish(*cube.node, cube.cell, anyChanged);
}

void mergeScan(const MergeTarget& target, const Scan& scan, Node& root, bool isNew, int threads) {
  std::deque<ScanMerger> mergers;
  for (int i = 0; i < threads; ++i) mergers.emplace_back(target, scan, i);
  const ScanCube whole{&root, isNew, Cell()};
  std::vector<ScanCube> parts;
  mergers[0].collect(whole, parts);

  std::vector<char> changed(parts.size());
  std::atomic<std::size_t> nextPart{0};
  const auto work = [&](ScanMerger& merger) {
    for (std::size_t i; (i = nextPart++) < parts.size();) changed[i] = merger.merge(parts[i]);
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back([&work, &m = mergers[i]] { work(m); });
  work(mergers[0]);
  for (std::thread& helper : helpers) helper.join();

  for (const ScanMerger& merger : mergers)
    for (const Cell& cube : merger.m_changed) target.touched->add(cube);
  std::size_t next = 0;
  mergers[0].finishAbove(whole, changed, next);
}

}  // namespace semantic_octree
