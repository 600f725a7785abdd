#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "OptimalTree.h"

namespace semantic_octree {

/** The optimal tree as it was last reported, to tell what changed. A node is an index: none, a
 * leaf, or an inner node's eight children. */
class ReportedTree {
 public:
  /** Compares with the map as it is now, remembers that, and returns the difference. Visits only
   * nodes that changed or have changed nodes below them. */
  TreeChange update(NodeStore& store, const AbstractionUpkeep& upkeep, Node& root);

  /** The same for a map that is empty now. */
  TreeChange clear(NodeStore& store, const AbstractionUpkeep& upkeep);

 private:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0, kLeaf = 1, kFirstInner = 2;

  struct Update {
    NodeStore& store;
    OptimalTree tree;
    TreeChange change;
  };
  void update(Update& u, Index& reported, Node& node, const Cell& cell);
  void updateChildren(Update& u, Index& reported, Node& node, const Cell& cell);
  void becomeLeaf(Update& u, Index& reported, const Node& node, const Cell& cell);
  /** Forgets a subtree, reporting its leaves as removed. */
  void remove(Update& u, Index reported, const Cell& cell);
  Index newInner();

  Index m_root = kNone;
  std::vector<std::array<Index, 8>> m_inner;
  std::vector<Index> m_free;
};

}  // namespace semantic_octree
