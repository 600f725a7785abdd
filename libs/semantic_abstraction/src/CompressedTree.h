#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/store/MapAccess.h>

#include <array>
#include <cmath>

#include "GTree.h"

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

/** G-tree search, its second half: the walk from a map's root down, along the nodes that GTree has
 * found worth expanding, to the leaves of the compressed tree. */
class CompressedTree {
 public:
  CompressedTree(const NodeStore& store, const GTree& gTree) : m_store(store), m_gTree(gTree) {}

  bool isExpanded(const Node& node) const {
    if (node.isLeaf()) return false;
    const InnerState& s = *state(NodeStore::slotOf(node));
    const int octant = NodeStore::octantOf(node);
    return octant < 0 ? s.isExpanded : s.expandedOctants >> octant & 1;
  }
  InnerState* state(const Slot& inner) const { return m_store.state<InnerState>(inner); }
  /** A leaf of the map that reaches above the blocks, where everything is expanded: its blocks are
   * the compressed tree's leaves. */
  bool isSplitAbove(const Node& node, const Cell& cell) const {
    return node.isLeaf() && m_gTree.isFreeFrame(cell.depth);
  }

  /** Calls f(node, cell) for each leaf in a cell, depth first. Does not go into nodes for which
   * isWanted(node, cell) is false. */
  template <typename F, typename W>
  void forEachLeaf(const Node& node, const Cell& cell, const W& isWanted, const F& f) const {
    if (!isWanted(node, cell)) return;
    if (isSplitAbove(node, cell)) {
      for (int i = 0; i < 8; ++i) forEachLeaf(node, cell.child(i), isWanted, f);
    } else if (isExpanded(node)) {
      for (int i = 0; i < 8; ++i)
        if (const Node child = node.child(i)) forEachLeaf(child, cell.child(i), isWanted, f);
    } else {
      f(node, cell);
    }
  }
  template <typename F>
  void forEachLeaf(const Node& node, const Cell& cell, const F& f) const {
    forEachLeaf(
        node, cell, [](const Node&, const Cell&) { return true; }, f);
  }

 private:
  const NodeStore& m_store;
  const GTree& m_gTree;
};

inline LeafCell leafCell(const Node& node, const Cell& cell) { return {cell.cube(), node}; }

}  // namespace semantic_octree
