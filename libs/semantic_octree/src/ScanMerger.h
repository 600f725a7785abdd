#pragma once
#include <semantic_octree/ClassFilter.h>

#include <vector>

#include "BlockUpdate.h"
#include "GTree.h"
#include "NodeStore.h"
#include "Scan.h"
#include "TileLog.h"

namespace semantic_octree {

/** What a scan is merged into. */
struct MergeTarget {
  NodeStore& store;
  const ClassFilter<float>& filter;
  /** Keeps inner nodes' bookkeeping up to date; null: there is none. */
  GTree* gTree;
  /** Is told where something changed; null: nobody wants to know. */
  TileLog* touched;
  /** Children that agree are merged; off: every known leaf is a voxel. */
  bool pruning;
};

/** A cube of the scan (see ScanPyramid) and the tree's node for it. */
struct ScanCube {
  Slot* slot;
  Cell cell;

  int level() const { return ScanPyramid::kTopLevel - cell.depth; }
  CubeContent content(const Scan& scan) const { return scan.pyramid().at(level(), cell.index); }
};

/** Carries a scan's voxels into a subtree, in one thread.
 *
 * The tree is descended once per tile of 8 x 8 x 8 voxels; on the way back up each inner node below
 * which something changed is pruned or recomputed once. A cube that the tree holds as one leaf and
 * that the scan saw free as a whole gets one update: the same values as updating its voxels one by
 * one and pruning. */
class ScanMerger {
 public:
  /** \param filter the target's, for this scan's labels \param thread number of the thread that it
   * works in */
  ScanMerger(const MergeTarget& target, const ClassFilter<float>& filter, const Scan& scan,
             int thread)
      : m_target(target),
        m_store(target.store),
        m_scan(scan),
        m_arena(target.store.arena(thread)),
        m_voxels(target.store, m_arena, filter, target.pruning),
        m_gTree(target.gTree ? &target.gTree->worker(thread) : nullptr) {}

  /** \return whether anything changed */
  bool merge(const ScanCube& cube);

 private:
  enum class Whole { Unchanged, Changed, Descend };
  Whole updateWhole(Slot& slot, bool allFree, bool anyHit);
  Octant& childrenOf(Slot& slot);
  /** Prunes or recomputes an inner node. \return changed */
  bool finish(Slot& slot, const Cell& cell, bool changed, bool reshaped = false);
  /** Takes down that a cube changed. \return changed */
  bool note(const Cell& cube, bool changed);

  bool mergeTile(const ScanCube& cube);
  bool mergeBlock(const ScanCube& cube, const BlockScan& scan);

  friend void mergeScan(const MergeTarget&, const Scan&, int threads);
  void collect(const ScanCube& cube, std::vector<ScanCube>& parts);
  bool finishAbove(const ScanCube& cube, const std::vector<char>& changed, std::size_t& next);

  const MergeTarget& m_target;
  NodeStore& m_store;
  const Scan& m_scan;
  NodeArena& m_arena;
  BlockUpdate m_voxels;
  GTree::Worker* m_gTree;
  std::vector<Cell> m_changed;
};

/** Merges a scan into the whole tree. The cubes of one level are shared among the threads, then the
 * nodes above them are finished; the result does not depend on the number of threads. */
void mergeScan(const MergeTarget& target, const Scan& scan, int threads);

}  // namespace semantic_octree
