#include <semantic_octree/SemanticOcTreeNode.h>
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

}  // namespace semantic_octree
