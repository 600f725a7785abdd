#include <semantic_octree/SemanticOcTree.h>

#include <algorithm>

namespace semantic_octree {

TreeIterator::TreeIterator(const SemanticOcTree& tree, const Selection& selection)
    : m_selection(selection), m_voxelSize(tree.getResolution()) {
  for (unsigned axis = 0; axis < 3; ++axis)
    m_hasBox |= selection.low[axis] > 0 || selection.high[axis] < kNumKeys - 1;
  if (tree.empty()) return;
  m_stack.reserve(8 * kTreeDepth);
  m_stack.push_back({tree.root(), {0, 0, 0}, 0});
  if (!isWanted(m_stack.back()))
    m_stack.clear();
  else if (!m_selection.innerNodes)
    toNext();
}

TreeIterator& TreeIterator::operator++() {
  isLast(m_stack.back()) ? m_stack.pop_back() : descend();
  if (!m_selection.innerNodes) toNext();
  return *this;
}

bool TreeIterator::isLeaf() const { return m_stack.back().node.isLeaf(); }

octomap::point3d TreeIterator::getCoordinate() const {
  return {static_cast<float>(getX()), static_cast<float>(getY()), static_cast<float>(getZ())};
}

bool TreeIterator::isWanted(const Entry& entry) const {
  const int edge = edgeAtDepth(entry.depth);
  for (unsigned axis = 0; axis < 3; ++axis)
    if (entry.lowest[axis] > m_selection.high[axis] ||
        entry.lowest[axis] + edge <= m_selection.low[axis])
      return false;
  return true;
}

void TreeIterator::descend() {
  const Entry inner = m_stack.back();
  m_stack.pop_back();
  const int half = edgeAtDepth(inner.depth + 1);
  for (int i = 7; i >= 0; --i) {
    const SemanticOcTreeNode child = inner.node.child(i);
    if (!child) continue;
    m_stack.push_back({child,
                       {inner.lowest[0] + (i & 1) * half, inner.lowest[1] + (i >> 1 & 1) * half,
                        inner.lowest[2] + (i >> 2) * half},
                       inner.depth + 1});
    if (m_hasBox && !isWanted(m_stack.back())) m_stack.pop_back();
  }
}

void TreeIterator::toNext() {
  while (!m_stack.empty() && !isLast(m_stack.back())) descend();
}

}  // namespace semantic_octree
