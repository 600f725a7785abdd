#include "CompressedTree.h"

namespace semantic_octree {

TreeChange LeafChanges::clear(const NodeStore& store, const GTree& gTree) {
  Update u{CompressedTree(store, gTree)};
  remove(u, m_root, Cell());
  m_root = kNone;
  return std::move(u.change);
}

TreeChange LeafChanges::update(const NodeStore& store, const GTree& gTree, const Node& root) {
  Update u{CompressedTree(store, gTree)};
  update(u, m_root, root, Cell());
  return std::move(u.change);
}

void LeafChanges::forget(const NodeStore& store, const GTree& gTree, const Node& root) {
  Update u{CompressedTree(store, gTree)};
  u.tells = false;
  update(u, m_root, root, Cell());
}

void LeafChanges::update(Update& u, Index& told, const Node& node, const Cell& cell) {
  if (!u.tree.isExpanded(node) && !u.tree.isSplitAbove(node, cell))
    return becomeLeaf(u, told, node, cell);
  const bool wasInner = told >= kFirstInner;
  const bool hasState = !node.isLeaf() && NodeStore::octantOf(node) < 0;
  InnerState* state = hasState ? u.tree.state(NodeStore::slotOf(node)) : nullptr;
  if (wasInner && state && !state->changedBelow) return;
  if (!wasInner) {
    remove(u, told, cell);
    told = newInner();
  }
  updateChildren(u, told, node, cell);
  if (state) state->changedBelow = 0;
}

void LeafChanges::updateChildren(Update& u, Index& told, const Node& node, const Cell& cell) {
  for (int i = 0; i < 8; ++i) {
    Index below = m_inner[told - kFirstInner][i];
    if (node.isLeaf()) {  // a leaf of the map above the blocks stands for each of its parts
      update(u, below, node, cell.child(i));
    } else if (const Node child = node.child(i)) {
      update(u, below, child, cell.child(i));
    } else {
      remove(u, below, cell.child(i));
      below = kNone;
    }
    m_inner[told - kFirstInner][i] = below;
  }
}

void LeafChanges::becomeLeaf(Update& u, Index& told, const Node& node, const Cell& cell) {
  if (told == kLeaf) return;
  remove(u, told, cell);
  told = kLeaf;
  ++m_numLeaves;
  if (u.tells) u.change.added.push_back(leafCell(node, cell));
}

void LeafChanges::remove(Update& u, Index told, const Cell& cell) {
  if (told == kNone) return;
  if (told == kLeaf) {
    --m_numLeaves;
    if (u.tells) u.change.removed.push_back(leafCell(Node(), cell));
    return;
  }
  for (int i = 0; i < 8; ++i) remove(u, m_inner[told - kFirstInner][i], cell.child(i));
  m_free.push_back(told);
}

LeafChanges::Index LeafChanges::newInner() {
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
