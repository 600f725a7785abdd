#pragma once
#include <semantic_octree/store/FusionRule.h>
#include <semantic_octree/store/NodeEditor.h>
#include <semantic_octree/store/Scan.h>

#include <memory>
#include <vector>

namespace semantic_octree {

/** A cube of the scan (see ScanPyramid) and the tree's node for it. */
struct ScanCube {
  Slot* slot;
  Cube cell;

  int level() const { return ScanPyramid::kTopLevel - cell.depth; }
  CubeContent content(const Scan& scan) const { return scan.pyramid().at(level(), indexOf(cell)); }
};

/** Carries a scan's voxels into a subtree, in one thread.
 *
 * The tree is descended once per tile of 8 x 8 x 8 voxels. On the way up each inner node above a
 * change is pruned or recomputed once. A leaf of the tree that the scan saw free as a whole gets
 * one update, with the values of single voxels' updates and pruning. */
class ScanMerger {
 public:
  /** \param rule the target's, for this scan's labels \param thread number of the thread that it
   * works in */
  ScanMerger(const MergeTarget& target, const FusionRule& rule, const Scan& scan, int thread)
      : m_nodes(target, thread),
        m_scan(scan),
        m_voxels(rule.begin(target.store, m_nodes.arena, target.pruning)),
        m_lowest(m_voxels->lowest()) {}

  /** \return whether anything changed */
  bool merge(const ScanCube& cube);

 private:
  enum class Whole { Unchanged, Changed, Descend };
  Whole updateWhole(Slot& slot, bool allFree, bool anyHit);
  Octant& childrenOf(Slot& slot);

  bool mergeTile(const ScanCube& cube);
  bool mergeBlock(const ScanCube& cube, const BlockScan& scan);

  friend void mergeScan(const MergeTarget&, const Scan&, int threads);
  void collect(const ScanCube& cube, std::vector<ScanCube>& parts);
  bool finishAbove(const ScanCube& cube, const std::vector<char>& changed, std::size_t& next);

  NodeEditor m_nodes;
  const Scan& m_scan;
  std::unique_ptr<BlockFusion> m_voxels;
  Units m_lowest;  ///< see BlockFusion
};

/** Merges a scan into the whole tree. The threads share the cubes of one level, then the nodes
 * above are finished. The result does not depend on the number of threads. */
void mergeScan(const MergeTarget& target, const Scan& scan, int threads);

}  // namespace semantic_octree
