#pragma once
#include <semantic_octree/Abstraction.h>

#include <array>
#include <cstdint>
#include <vector>

#include "GTree.h"

namespace semantic_octree {

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

/** The compressed tree whose leaves were told last, to tell which came and went since. A node is an
 * index: none, a leaf, or an inner node's eight children. */
class LeafChanges {
 public:
  /** Compares with the map as it is now, remembers that, and returns the difference. Visits only
   * nodes that changed or have changed nodes below them. */
  TreeChange update(const NodeStore& store, const GTree& gTree, const Node& root);
  /** The same for a map that is empty now. */
  TreeChange clear(const NodeStore& store, const GTree& gTree);
  /** As update(), without a word. */
  void forget(const NodeStore& store, const GTree& gTree, const Node& root);
  /** That were told and are not gone. */
  std::size_t numLeaves() const { return m_numLeaves; }

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0, kLeaf = 1, kFirstInner = 2;

  struct Update {
    CompressedTree tree;
    TreeChange change = {};
    bool tells = true;
  };
  void update(Update& u, Index& told, const Node& node, const Cell& cell);
  void updateChildren(Update& u, Index& told, const Node& node, const Cell& cell);
  void becomeLeaf(Update& u, Index& told, const Node& node, const Cell& cell);
  /** Forgets a subtree, telling that its leaves are gone. */
  void remove(Update& u, Index told, const Cell& cell);
  Index newInner();

  Index m_root = kNone;
  std::size_t m_numLeaves = 0;
  std::vector<std::array<Index, 8>> m_inner;
  std::vector<Index> m_free;
};

}  // namespace semantic_octree
