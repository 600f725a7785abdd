#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/store/MapAccess.h>

#include <array>
#include <cmath>

#include "CompressedTree.h"

namespace semantic_octree {

/** p(n) of a node per unit of density: its share of the whole map's volume. */
inline double volumeOf(const Cell& cell) { return std::ldexp(1.0, -3 * cell.depth); }

/** p(n). \param total p(x) of the whole map, unnormalized */
inline double shareOf(const InnerNode& n, double total) {
  return total > 0 ? n.density * volumeOf(n.cell) / total : 0.0;
}

/** Tells which inner nodes are in the compressed tree, as they are visited, parents first. */
class InCompressedTree {
 public:
  bool visit(const InnerNode& n) {
    const int depth = n.cell.depth;
    return m_atDepth[depth] = n.isExpanded && (depth == 0 || m_atDepth[depth - 1]);
  }

 private:
  std::array<bool, kTreeDepth> m_atDepth{};  ///< of the node that was visited last
};

template <typename F>
void Abstraction::forEachInner(const F& f) const {
  NodeStore& store = MapAccess::store(m_map);
  GTree::Worker& worker = m_gTree.worker(0);
  const auto visit = [&](const auto& self, const Slot& slot, const Cell& cell) -> void {
    if (!slot.isInner()) return;
    store.bring(slot);
    worker.inspect(store, slot, cell, f);
    if (slot.kind == Slot::Kind::Octant)
      for (int i = 0; i < 8; ++i) self(self, store.octant(slot).slots[i], cell.child(i));
  };
  visit(visit, store.root(), Cell());
}

}  // namespace semantic_octree
