#pragma once
#include <semantic_octree/store/ChangeLog.h>

#include "CompressedTree.h"

namespace semantic_octree {

/** The leaves of a compressed tree that came and went, and the tree as it was last seen. A node of
 * that is an index: none, a leaf, or an inner node's eight children. */
class LeafLog : public ChangeLog<std::uint64_t> {
 public:
  /** Compares with the map as it is now, remembers that, and writes down the difference if anybody
   * reads it. Visits only nodes that changed or have changed nodes below them. If it fails, the log
   * is of no use any more. */
  void update(const NodeStore& store, const GTree& gTree, const Node& root);
  std::size_t numLeaves() const { return m_numLeaves; }
  /** All leaves. */
  TreeChange everything() const;
  /** What is different. */
  static TreeChange since(const Place& place);

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0, kLeaf = 1, kFirstInner = 2;

  void update(const CompressedTree& tree, Index& told, const Node& node, const Cube& cell);
  void updateChildren(const CompressedTree& tree, Index& told, const Node& node, const Cube& cell);
  void becomeLeaf(Index& told, const Cube& cell);
  /** Forgets a subtree. */
  void remove(Index told, const Cube& cell);
  void note(const Cube& leaf, bool isAdded);
  Index newInner();
  void addLeaves(Index told, const Cube& cell, std::vector<LeafCell>& leaves) const;

  Index m_root = kNone;
  std::size_t m_numLeaves = 0;
  std::vector<std::array<Index, 8>> m_inner;
  std::vector<Index> m_free;
  bool m_notes = false;  ///< somebody reads it
};

}  // namespace semantic_octree
