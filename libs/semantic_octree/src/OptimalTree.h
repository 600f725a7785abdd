#pragma once
#include <semantic_octree/Abstraction.h>

#include "AbstractionUpkeep.h"

namespace semantic_octree {

/** Walks over the optimal tree of a map. */
class OptimalTree {
 public:
  OptimalTree(const NodeStore& store, const AbstractionUpkeep& upkeep)
      : m_store(store), m_upkeep(upkeep) {}

  bool isExpanded(const Node& node) const {
    return !node.isLeaf() && m_store.state<InnerState>(node)->isExpanded;
  }
  /** A leaf of the map that reaches above the blocks, where everything is expanded: its blocks are
   * the optimal tree's leaves. */
  bool isSplitAbove(const Node& node, const Cell& cell) const {
    return node.isLeaf() && m_upkeep.isFreeFrame(cell.depth);
  }

  /** Calls f(node, cell) for each leaf in a cell, depth first. Does not go into nodes for which
   * isWanted(node, cell) is false. */
  template <typename F, typename W>
  void forEachLeaf(const Node& node, const Cell& cell, const W& isWanted, const F& f) const {
    if (!isWanted(node, cell)) return;
    if (isSplitAbove(node, cell)) {
      for (int i = 0; i < 8; ++i) forEachLeaf(node, cell.child(i), isWanted, f);
    } else if (isExpanded(node)) {
      for (const Node& child : NodeStore::octant(node).nodes) m_store.prefetchInner(child);
      for (int i = 0; i < 8; ++i)
        if (const Node* child = NodeStore::child(node, i))
          forEachLeaf(*child, cell.child(i), isWanted, f);
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
  const AbstractionUpkeep& m_upkeep;
};

inline LeafCell leafCell(const Node* node, const Cell& cell) {
  return {cell.key(), static_cast<unsigned>(cell.depth), node};
}

}  // namespace semantic_octree
