#include "TreeFormat.h"

#include <semantic_octree/Keys.h>

#include <cmath>

#include "NodeStore.h"

namespace semantic_octree {

using semantic_types::Color;
using semantic_types::kMaxClasses;

SemanticOcTree TreeReader::read() {
  const auto resolution = m_in.get<double>();
  const bool pruning = getUpTo(1, "pruning");
  const FilterParameters parameters = getParameters();
  SemanticOcTree tree(resolution, getClasses(), parameters);
  tree.setPruning(pruning);
  if (const auto numNodes = m_in.get<std::uint64_t>(); numNodes > 0) getNodes(tree, numNodes);
  m_in.finish();
  return tree;
}

std::uint8_t TreeReader::getUpTo(int last, const char* what) {
  const auto value = m_in.get<std::uint8_t>();
  if (value > last)
    throw std::runtime_error(std::string("altered: ") + what + " = " + std::to_string(value) +
                             ", expected 0 to " + std::to_string(last));
  return value;
}

FilterParameters TreeReader::getParameters() {
  FilterParameters p;
  p.increments = static_cast<FilterParameters::Increments>(getUpTo(1, "increments"));
  for (double* x : {&p.accuracy, &p.hitProbability, &p.falseAlarmProbability, &p.minOccupancy,
                    &p.maxProbability, &p.softLabelFloor})
    *x = m_in.get<double>();
  return p;
}

ClassTable TreeReader::getClasses() {
  ClassTable classes;
  for (int left = getUpTo(kMaxClasses, "number of classes"); left > 0; --left) {
    const std::string name = m_in.getText();
    Color color;
    for (std::uint8_t* channel : {&color.r, &color.g, &color.b})
      *channel = m_in.get<std::uint8_t>();
    classes.add(name, color);
  }
  classes.setUnknownRawId(static_cast<ClassTable::UnknownRawId>(getUpTo(1, "unknown raw id")));
  for (auto left = m_in.get<std::uint32_t>(); left > 0; --left) {
    const auto rawId = m_in.get<std::uint32_t>();
    classes.fold(rawId, m_in.get<ClassId>());
  }
  return classes;
}

void TreeReader::getNodes(SemanticOcTree& tree, std::uint64_t expectedNodes) {
  m_store = tree.m_store.get();
  m_arena = &m_store->arena(0);
  m_numClasses = tree.numClasses();
  getNode(m_store->root(), static_cast<NodeKind>(getUpTo(3, "node kind")), 0);
  if (m_store->numNodes() != expectedNodes)
    throw std::runtime_error("altered: " + std::to_string(m_store->numNodes()) +
                             " nodes, expected " + std::to_string(expectedNodes));
  tree.attachRoot();
}

void TreeReader::getNode(Node& node, NodeKind kind, int depth) {
  if (kind == NodeKind::None) throw std::runtime_error("altered: a map with nodes but no root");
  if (kind == NodeKind::Inner) return getChildren(node, depth);
  node.setValue(getLogOdds());
  if (kind == NodeKind::LeafWithRecord) getRecord(node);
}

void TreeReader::getRecord(Node& leaf) {
  Belief belief;
  belief.count = getUpTo(std::min(3, m_numClasses), "named classes");
  belief.rest = getLogOdds();
  for (int i = 0; i < belief.count; ++i) {
    belief.ids[i] = getUpTo(m_numClasses, "class");
    belief.logOdds[i] = getLogOdds();
  }
  m_arena->setRecord(leaf, belief);
}

void TreeReader::getChildren(Node& inner, int depth) {
  const auto kinds = m_in.get<std::uint16_t>();
  if (kinds == 0) throw std::runtime_error("altered: an inner node without children");
  if (depth == kTreeDepth) throw std::runtime_error("altered: more than 16 levels");
  Octant& octant = m_arena->createOctant(inner);
  const auto kindOf = [kinds](int i) { return static_cast<NodeKind>(kinds >> 2 * i & 3); };
  for (int i = 0; i < 8; ++i) {
    if (kindOf(i) == NodeKind::None) continue;
    Node& child = m_arena->createChild(octant, i);
    if (kindOf(i) != NodeKind::Inner) getNode(child, kindOf(i), depth + 1);
  }
  for (int i = 0; i < 8; ++i)
    if (kindOf(i) == NodeKind::Inner) getNode(octant.nodes[i], NodeKind::Inner, depth + 1);
  NodeStore::updateOccupancy(inner);
}

float TreeReader::getLogOdds() {
  const auto value = m_in.get<float>();
  if (!std::isfinite(value)) throw std::runtime_error("altered: a log-odds that is not finite");
  return value;
}

}  // namespace semantic_octree
