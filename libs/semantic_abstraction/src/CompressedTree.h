#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/store/MapAccess.h>

#include "GTree.h"

namespace semantic_octree {

/** The second half of G-tree search: from a map's root down, along the nodes that GTree found worth
 * expanding, to the compressed tree's leaves. */
class CompressedTree {
 public:
  CompressedTree(const NodeStore& store, const GTree& gTree) : m_store(store), m_gTree(gTree) {}

  bool isExpanded(const Node& node) const {
    if (node.isLeaf()) return false;
    const BlockState& s = *state(NodeStore::slotOf(node));
    const int octant = NodeStore::octantOf(node);
    return octant < 0 ? s.isExpanded : s.expandedOctants >> octant & 1;
  }
  BlockState* state(const Slot& inner) const { return m_store.state<BlockState>(inner); }
  /** A leaf of the map that reaches above the blocks, where everything is expanded: its blocks are
   * the compressed tree's leaves. */
  bool isSplitAbove(const Node& node, const Cube& cell) const {
    return node.isLeaf() && m_gTree.isFreeFrame(cell.depth);
  }

  /** Calls f(node, cell) for each leaf in a cell, depth first. Does not go into nodes for which
   * isWanted(node, cell) is false. */
  template <typename F, typename W>
  void forEachLeaf(const Node& node, const Cube& cell, const W& isWanted, const F& f) const {
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

 private:
  const NodeStore& m_store;
  const GTree& m_gTree;
};

}  // namespace semantic_octree
