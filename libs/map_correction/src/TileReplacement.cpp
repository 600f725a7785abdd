#include "TileReplacement.h"

#include <semantic_octree/store/TreeComparison.h>

#include <algorithm>

namespace semantic_octree {
namespace {

class TileReplacement {
 public:
  TileReplacement(const MergeTarget& target, const NodeStore& source)
      : m_nodes(target, 0),
        m_store(target.store),
        m_source(source),
        m_comparison(target.store, source, nullptr) {}

  void replace(const TileRange& tiles) {
    replace(m_store.root(), Cell(), tiles, m_source.root());
    m_nodes.tellNoted();
  }

 private:
  /** \param tiles those below the node \param source the other tree's node there; a leaf stands for
   * all that is below \return whether anything changed */
  bool replace(Slot& slot, const Cell& cell, const TileRange& tiles, const Slot& source) {
    m_store.bring(slot);
    const bool changed = cell.depth == kTileDepth
                             ? m_nodes.note(cell, replaceAll(slot, cell, source))
                             : replaceBelow(slot, cell, tiles, source);
    if (changed) m_store.tellChanged(slot, cell);
    return changed;
  }

  bool replaceBelow(Slot& slot, const Cell& cell, const TileRange& tiles, const Slot& source) {
    if (!slot.isInner() && !source.isInner() && m_comparison.same(slot, source)) return false;
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

  bool finish(Slot& slot, const Cell& cell, bool changed) {
    const Octant& octant = m_store.octant(slot);
    const bool isEmpty = std::none_of(octant.slots, octant.slots + 8,
                                      [](const Slot& child) { return child.isKnown(); });
    if (isEmpty && !changed) {  // it was made in vain
      m_nodes.arena.remove(slot);
      return false;
    }
    return m_nodes.finish(slot, cell, changed, true);
  }

  /** A node that was replaced knows nothing of what was told of the one before: it counts as
   * reshaped. */
  void recompute(Slot& inner, const Cell& cell) { m_nodes.recompute(inner, cell, true); }

  /** A tile, or a node below. What is alike stays where it is. */
  bool replaceAll(Slot& slot, const Cell& cell, const Slot& source) {
    if (m_comparison.same(slot, source)) return false;
    if (slot.kind != Slot::Kind::Octant || source.kind != Slot::Kind::Octant) {
      if (slot.isKnown()) m_nodes.arena.remove(slot);
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
    if (unknown.isInner()) recompute(unknown, cell);
  }

  NodeEditor m_nodes;
  NodeStore& m_store;
  const NodeStore& m_source;
  TreeComparison m_comparison;
};

}  // namespace

void replaceTiles(const MergeTarget& target, const TileCodes& tiles, const NodeStore& source) {
  const TileRange all{tiles.begin(), tiles.end()};
  if (!all.empty()) TileReplacement(target, source).replace(all);
}

}  // namespace semantic_octree
