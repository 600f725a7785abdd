#include "ReportedTree.h"

namespace semantic_octree {

TreeChange ReportedTree::clear(NodeStore& store, const AbstractionUpkeep& upkeep) {
  Update u{store, OptimalTree(store, upkeep), {}};
  remove(u, m_root, Cell());
  m_root = kNone;
  return std::move(u.change);
}

TreeChange ReportedTree::update(NodeStore& store, const AbstractionUpkeep& upkeep, Node& root) {
  Update u{store, OptimalTree(store, upkeep), {}};
  update(u, m_root, root, Cell());
  return std::move(u.change);
}

void ReportedTree::update(Update& u, Index& reported, Node& node, const Cell& cell) {
  if (!u.tree.isExpanded(node) && !u.tree.isSplitAbove(node, cell))
    return becomeLeaf(u, reported, node, cell);
  const bool wasInner = reported >= kFirstInner;
  InnerState* state = node.isLeaf() ? nullptr : u.store.state<InnerState>(node);
  if (wasInner && state && !state->changedBelow) return;
  if (!wasInner) {
    remove(u, reported, cell);
    reported = newInner();
  }
  updateChildren(u, reported, node, cell);
  if (state) state->changedBelow = 0;
}

void ReportedTree::updateChildren(Update& u, Index& reported, Node& node, const Cell& cell) {
  for (int i = 0; i < 8; ++i) {
    Index below = m_inner[reported - kFirstInner][i];
    if (node.isLeaf()) {  // a leaf of the map above the blocks stands for each of its parts
      update(u, below, node, cell.child(i));
    } else if (Octant& octant = NodeStore::octant(node); octant.has(i)) {
      update(u, below, octant.nodes[i], cell.child(i));
    } else {
      remove(u, below, cell.child(i));
      below = kNone;
    }
    m_inner[reported - kFirstInner][i] = below;
  }
}

void ReportedTree::becomeLeaf(Update& u, Index& reported, const Node& node, const Cell& cell) {
  if (reported == kLeaf) return;
  remove(u, reported, cell);
  reported = kLeaf;
  u.change.added.push_back(leafCell(&node, cell));
}

void ReportedTree::remove(Update& u, Index reported, const Cell& cell) {
  if (reported == kNone) return;
  if (reported == kLeaf) return u.change.removed.push_back(leafCell(nullptr, cell));
  for (int i = 0; i < 8; ++i) remove(u, m_inner[reported - kFirstInner][i], cell.child(i));
  m_free.push_back(reported);
}

ReportedTree::Index ReportedTree::newInner() {
  if (m_free.empty()) {
    m_inner.push_back({});
    return static_cast<Index>(m_inner.size()) - 1 + kFirstInner;
  }
  const Index index = m_free.back();
  m_free.pop_back();
  m_inner[index - kFirstInner].fill(kNone);
  return index;
}

}  // namespace semantic_octree
