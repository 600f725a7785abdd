#include "TileReplacement.h"

#include <algorithm>

#include "TreeComparison.h"

namespace semantic_octree {
namespace {

class TileReplacement {
 public:
  TileReplacement(const MergeTarget& target, const NodeStore& source)
      : m_target(target),
        m_store(target.store),
        m_source(source),
        m_arena(target.store.arena(0)),
        m_gTree(target.gTree ? &target.gTree->worker(0) : nullptr),
        m_comparison(target.store, source, false) {}

  /** \param tiles those below the node \param source the other tree's node there; a leaf stands for
   * all that is below \return whether anything changed */
  bool replace(Slot& slot, const Cell& cell, const TileRange& tiles, const Slot& source) {
    if (cell.depth == kTileDepth) return note(cell, replaceAll(slot, cell, source));
    if (!slot.isInner() && !source.isInner() && m_comparison.same(slot, source)) return false;
    Octant& octant = slot.isInner()   ? m_store.octant(slot)
                     : slot.isKnown() ? m_arena.expandToOctant(slot)
                                      : m_arena.createOctant(slot);
    bool changed = false;
    for (int i = 0; i < 8; ++i) {
      const TileRange below = tiles.below(cell.depth, i);
      const Slot& child = source.isInner() ? m_source.octant(source).slots[i] : source;
      if (!below.empty()) changed |= replace(octant.slots[i], cell.child(i), below, child);
    }
    return finish(slot, cell, changed);
  }

 private:
  bool note(const Cell& tile, bool changed) {
    if (changed && m_target.touched) m_target.touched->add(tile);
    return changed;
  }

  bool finish(Slot& slot, const Cell& cell, bool changed) {
    const Octant& octant = m_store.octant(slot);
    if (std::none_of(octant.slots, octant.slots + 8, [](const Slot& s) { return s.isKnown(); })) {
      m_arena.remove(slot);
      return changed;
    }
    if ((m_target.pruning && m_arena.prune(slot)) || !changed) return changed;
    slot.value = m_store.highestValueBelow(slot);
    recompute(slot, cell);
    return true;
  }

  /** A node that was replaced knows nothing of what was told of the one before: it counts as
   * reshaped. */
  void recompute(Slot& inner, const Cell& cell) {
    if (m_gTree) m_gTree->recompute(m_store, inner, cell, true);
  }

  /** A tile, or a node below. What is alike stays where it is. */
  bool replaceAll(Slot& slot, const Cell& cell, const Slot& source) {
    if (m_comparison.same(slot, source)) return false;
    if (slot.kind != Slot::Kind::Octant || source.kind != Slot::Kind::Octant) {
      if (slot.isKnown()) m_arena.remove(slot);
      copy(slot, cell, source);
      return true;
    }
    for (int i = 0; i < 8; ++i)
      replaceAll(m_store.octant(slot).slots[i], cell.child(i), m_source.octant(source).slots[i]);
    slot.value = source.value;
    recompute(slot, cell);
    return true;
  }

  void copy(Slot& unknown, const Cell& cell, const Slot& source) {
    if (source.isLeaf()) {
      m_arena.createLeaf(unknown, source.value);
      if (source.kind == Slot::Kind::LeafWithRecord)
        m_arena.setRecord(unknown, m_source.record(source));
    } else if (source.kind == Slot::Kind::Octant) {
      Octant& octant = m_arena.createOctant(unknown);
      for (int i = 0; i < 8; ++i)
        copy(octant.slots[i], cell.child(i), m_source.octant(source).slots[i]);
    } else if (source.kind == Slot::Kind::Block) {
      m_arena.createBlock(unknown, m_source.contentOf(m_source.block(source)));
    }
    unknown.value = source.value;
    if (unknown.isInner()) recompute(unknown, cell);
  }

  const MergeTarget& m_target;
  NodeStore& m_store;
  const NodeStore& m_source;
  NodeArena& m_arena;
  GTree::Worker* m_gTree;
  TreeComparison m_comparison;
};

}  // namespace

void replaceTiles(const MergeTarget& target, const TileCodes& tiles, const NodeStore& source) {
  const TileRange all{tiles.begin(), tiles.end()};
  if (!all.empty())
    TileReplacement(target, source).replace(target.store.root(), Cell(), all, source.root());
}

}  // namespace semantic_octree
