#include "NodeStore.h"

#include <algorithm>
#include <cmath>

namespace semantic_octree {

NodeStore::NodeStore(std::size_t stateBytes)
    : m_stateBytes(stateBytes), m_records(sizeof(Belief)), m_states(stateBytes) {}

NodeArena& NodeStore::arena(int i) {
  while (static_cast<int>(m_arenas.size()) <= i) m_arenas.emplace_back(*this);
  return m_arenas[i];
}

std::size_t NodeStore::numNodes() const {
  long n = 1;
  for (const NodeArena& arena : m_arenas) n += arena.nodes();
  return static_cast<std::size_t>(n);
}

std::size_t NodeStore::numInnerNodes() const {
  long n = 0;
  for (const NodeArena& arena : m_arenas) n += arena.innerNodes();
  return static_cast<std::size_t>(n);
}

void NodeStore::updateOccupancy(Node& inner) {
  const Octant& o = octant(inner);
  float highest = -HUGE_VALF;
  for (int i = 0; i < 8; ++i)
    if (o.has(i)) highest = std::max(highest, o.nodes[i].getValue());
  inner.setValue(highest);
}

NodeArena::NodeArena(NodeStore& store)
    : m_store(store),
      m_octants(store.m_octants),
      m_records(store.m_records),
      m_states(store.m_states) {}

Octant& NodeArena::createOctant(Node& node) {
  Octant* octant = m_octants.allocate();
  node.children = octant->pointers;
  ++m_inner;
  node.m_index = 0;
  if (m_store.m_stateBytes > 0) {
    node.m_index = m_states.allocate();
    std::memset(m_store.state<void>(node), 0, m_store.m_stateBytes);
  }
  return *octant;
}

Octant& NodeArena::expand(Node& leaf) {
  const std::uint32_t record = leaf.m_index;
  Octant& octant = createOctant(leaf);
  for (int i = 0; i < 8; ++i) {
    Node& child = octant.child(i);
    child.setValue(leaf.getValue());
    child.m_index = record;
    if (record && i > 0) {
      child.m_index = m_records.allocate();
      m_store.record(child) = *m_store.m_records.at<Belief>(record);
    }
  }
  m_nodes += 8;
  return octant;
}

void NodeArena::removeOctant(Node& node) {
  if (node.m_index) m_states.release(node.m_index);
  node.m_index = 0;
  m_octants.release(&NodeStore::octant(node));
  node.children = nullptr;
  --m_inner;
}

bool NodeArena::childrenAgree(const Octant& octant) const {
  const Node& first = octant.nodes[0];
  for (int i = 0; i < 8; ++i) {
    const Node& child = octant.nodes[i];
    if (!octant.has(i) || !child.isLeaf() || child.getValue() != first.getValue() ||
        child.hasClassRecord() != first.hasClassRecord())
      return false;
  }
  if (first.hasClassRecord())
    for (int i = 1; i < 8; ++i)
      if (!(m_store.record(octant.nodes[i]) == m_store.record(first))) return false;
  return true;
}

bool NodeArena::prune(Node& inner) {
  Octant& octant = m_store.octant(inner);
  if (!childrenAgree(octant)) return false;
  if (inner.m_index) m_states.release(inner.m_index);
  inner.m_index = octant.nodes[0].m_index;
  inner.setValue(octant.nodes[0].getValue());
  inner.children = nullptr;
  for (int i = 1; i < 8; ++i)
    if (octant.nodes[i].m_index) m_records.release(octant.nodes[i].m_index);
  m_octants.release(&octant);
  --m_inner;
  m_nodes -= 8;
  return true;
}

void NodeArena::setRecord(Node& leaf, const Belief& belief) {
  if (!leaf.m_index) leaf.m_index = m_records.allocate();
  m_store.record(leaf) = belief;
}

void NodeArena::dropRecord(Node& leaf) {
  m_records.release(leaf.m_index);
  leaf.m_index = 0;
}

void NodeArena::copy(const NodeStore& source, const Node& from, Node& to) {
  to.setValue(from.getValue());
  if (from.isLeaf()) {
    if (from.hasClassRecord()) setRecord(to, source.record(from));
    return;
  }
  Octant& octant = createOctant(to);
  if (m_store.m_stateBytes > 0 && source.m_stateBytes == m_store.m_stateBytes)
    std::memcpy(m_store.state<void>(to), source.state<void>(from), m_store.m_stateBytes);
  for (int i = 0; i < 8; ++i)
    if (const Node* child = from.child(i)) copy(source, *child, createChild(octant, i));
}

}  // namespace semantic_octree
