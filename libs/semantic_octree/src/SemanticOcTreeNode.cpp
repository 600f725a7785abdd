#include <semantic_octree/SemanticOcTreeNode.h>

#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/NodeStore.h>

#include <algorithm>
#include <cmath>

namespace semantic_octree {

bool SemanticOcTreeNode::isLeaf() const {
  if (m_part == kWhole) return m_slot->isLeaf();
  return !isOctant() || m_store->block(*m_slot).isLeafOctant(m_part - kFirstOctant);
}

SemanticOcTreeNode SemanticOcTreeNode::child(int i) const {
  m_store->bring(*m_slot);
  if (m_slot->kind == Slot::Kind::Octant) {
    const Slot& slot = m_store->octant(*m_slot).slots[i];
    return slot.isKnown() ? SemanticOcTreeNode(*m_store, slot) : SemanticOcTreeNode();
  }
  const Block& block = m_store->block(*m_slot);
  if (m_part == kWhole)
    return block.knownIn(i) ? SemanticOcTreeNode(*m_store, *m_slot, kFirstOctant + i)
                            : SemanticOcTreeNode();
  const int voxel = 8 * (m_part - kFirstOctant) + i;
  return block.known >> voxel & 1 ? SemanticOcTreeNode(*m_store, *m_slot, kFirstVoxel + voxel)
                                  : SemanticOcTreeNode();
}

float SemanticOcTreeNode::getLogOdds() const {
  if (m_part == kWhole) return fromUnits(m_slot->value);
  const Units* values = m_store->block(*m_slot).values;
  if (!isOctant()) return fromUnits(values[m_part - kFirstVoxel]);
  values += 8 * (m_part - kFirstOctant);
  return fromUnits(*std::max_element(values, values + 8));
}

double SemanticOcTreeNode::getOccupancy() const {
  return 1 / (1 + std::exp(-static_cast<double>(getLogOdds())));
}

bool SemanticOcTreeNode::hasClassRecord() const {
  if (m_part == kWhole) return m_slot->kind == Slot::Kind::LeafWithRecord;
  const Block& block = m_store->block(*m_slot);
  if (!isOctant()) return block.hasRecord(m_part - kFirstVoxel);
  const int octant = m_part - kFirstOctant;
  return block.isLeafOctant(octant) && block.hasRecord(8 * octant);
}

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

Units Block::highestValue() const {
  Units highest = kUnknown;  // not std::max_element(), which looks at one value after the other
  for (const Units value : values) highest = std::max(highest, value);
  return highest;
}

void BlockContent::setVoxel(int voxel, Units value, const ClassRecord* record) {
  values[voxel] = value;
  known |= VoxelBits(1) << voxel;
  if (!record) return;
  recorded |= VoxelBits(1) << voxel;
  records[voxel] = *record;
}

void BlockContent::setLeafOctant(int octant, Units value, const ClassRecord* record) {
  setVoxel(8 * octant, value, record);
  std::fill_n(values + 8 * octant, 8, value);
  known |= VoxelBits(0xff) << 8 * octant;
  leafOctants |= static_cast<std::uint8_t>(1u << octant);
}

void BlockContent::mergeOctant(int octant) {
  const int first = 8 * octant;
  const auto bitsOf = [first](VoxelBits bits) { return bits >> first & 0xff; };
  if (bitsOf(known) != 0xff || (bitsOf(recorded) != 0 && bitsOf(recorded) != 0xff)) return;
  for (int i = first + 1; i < first + 8; ++i)
    if (values[i] != values[first] || (bitsOf(recorded) && records[i] != records[first])) return;
  leafOctants |= static_cast<std::uint8_t>(1u << octant);
  recorded &= ~(VoxelBits(0xfe) << first);
}

}  // namespace semantic_octree
