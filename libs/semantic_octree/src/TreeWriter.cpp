#include "TreeFormat.h"

namespace semantic_octree {

using semantic_types::Color;

void TreeWriter::write() {
  m_out.put(m_tree.getResolution());
  m_out.put(m_tree.pruning());
  putParameters(m_tree.filterParameters());
  putClasses(m_tree.classes());
  m_out.put<std::uint64_t>(m_tree.size());
  if (const Node* root = m_tree.root()) {
    m_out.put(static_cast<std::uint8_t>(kindOf(*root)));
    root->isLeaf() ? putLeaf(*root) : putChildren(*root);
  }
  m_out.finish();
}

void TreeWriter::putParameters(const FilterParameters& p) {
  m_out.put(static_cast<std::uint8_t>(p.increments));
  for (const double x : {p.accuracy, p.hitProbability, p.falseAlarmProbability, p.minOccupancy,
                         p.maxProbability, p.softLabelFloor})
    m_out.put(x);
}

void TreeWriter::putClasses(const ClassTable& classes) {
  m_out.put(static_cast<std::uint8_t>(classes.size()));
  for (int id = 1; id <= classes.size(); ++id) {
    const Color& color = classes.color(static_cast<ClassId>(id));
    m_out.put(classes.name(static_cast<ClassId>(id)));
    for (const std::uint8_t channel : {color.r, color.g, color.b}) m_out.put(channel);
  }
  m_out.put(static_cast<std::uint8_t>(classes.unknownRawId()));
  m_out.put(static_cast<std::uint32_t>(classes.folds().size()));
  for (const auto& [rawId, id] : classes.folds()) {
    m_out.put(rawId);
    m_out.put(id);
  }
}

NodeKind TreeWriter::kindOf(const Node& node) {
  if (!node.isLeaf()) return NodeKind::Inner;
  return node.hasClassRecord() ? NodeKind::LeafWithRecord : NodeKind::Leaf;
}

void TreeWriter::putLeaf(const Node& leaf) {
  m_out.put(leaf.getValue());
  if (!leaf.hasClassRecord()) return;
  const Belief belief = m_tree.belief(leaf);
  m_out.put(belief.count);
  m_out.put(belief.rest);
  for (int i = 0; i < belief.count; ++i) {
    m_out.put(belief.ids[i]);
    m_out.put(belief.logOdds[i]);
  }
}

void TreeWriter::putChildren(const Node& inner) {
  std::uint16_t kinds = 0;
  for (int i = 0; i < 8; ++i)
    if (const Node* child = inner.child(i))
      kinds |= static_cast<std::uint16_t>(static_cast<unsigned>(kindOf(*child)) << 2 * i);
  m_out.put(kinds);
  for (int i = 0; i < 8; ++i)
    if (const Node* child = inner.child(i); child && child->isLeaf()) putLeaf(*child);
  for (int i = 0; i < 8; ++i)
    if (const Node* child = inner.child(i); child && !child->isLeaf()) putChildren(*child);
}

}  // namespace semantic_octree
