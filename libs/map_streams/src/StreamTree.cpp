#include "StreamTree.h"

#include <semantic_octree/store/TreeBuilder.h>

namespace semantic_octree {
namespace {

/** A stream's tree for TreeBuilder. */
class StreamCursor {
 public:
  StreamCursor(const StreamTree& tree, const StreamTree::Node& node) : m_tree(tree), m_node(node) {}
  bool known() const { return m_node.isKnown(); }
  bool isLeaf() const { return !m_node.isInner(); }
  LeafContent content() const { return m_node.leaf.content(); }
  StreamCursor child(int i) const { return {m_tree, isLeaf() ? m_node : m_tree.child(m_node, i)}; }

 private:
  const StreamTree& m_tree;
  const StreamTree::Node& m_node;
};

}  // namespace

CellPath CellPath::of(const Cube& cube) {
  CellPath cell;
  while (cell.depth < cube.depth) {
    const int bit = kTreeDepth - 1 - cell.depth;
    const Eigen::Array3i& lowest = cube.lowest;
    cell = cell.child((lowest.x() >> bit & 1) | (lowest.y() >> bit & 1) << 1 |
                      (lowest.z() >> bit & 1) << 2);
  }
  return cell;
}

StreamLeaf StreamLeaf::of(const LeafContent& content) {
  StreamLeaf leaf;
  leaf.kind = content.record ? Kind::WithRecord : Kind::Plain;
  leaf.value = content.value;
  if (content.record) leaf.record = *content.record;
  return leaf;
}

LeafContent StreamLeaf::content() const {
  LeafContent c{value, std::nullopt};
  if (kind == Kind::WithRecord) c.record = record;
  return c;
}

StreamTree::StreamTree() : m_octets(1) {}

StreamTree::Node* StreamTree::find(const CellPath& cell) {
  Node* node = &m_root;
  for (int depth = 1; depth <= cell.depth; ++depth) {
    if (!node->isInner()) return nullptr;
    node = &m_octets[node->octet].nodes[cell.childAt(depth)];
  }
  return node->isKnown() ? node : nullptr;
}

void StreamTree::reserve() {
  constexpr std::size_t kMost = kTreeDepth + 1;  // octets that a part makes
  if (m_octets.capacity() - m_octets.size() >= kMost) return;
  m_octets.reserve(2 * m_octets.size() + kMost);
  m_free.reserve(m_octets.capacity());
}

StreamTree::Node& StreamTree::makePlace(const CellPath& cell, std::uint32_t revision) {
  Node* node = &m_root;
  for (int depth = 1; depth <= cell.depth; ++depth) {
    if (!node->isInner()) makeInner(*node, StreamLeaf(node->leaf), revision);
    node = &m_octets[node->octet].nodes[cell.childAt(depth)];
  }
  return *node;
}

std::uint32_t StreamTree::makeInner(Node& leaf, const StreamLeaf& children,
                                    std::uint32_t revision) {
  std::uint32_t octet = static_cast<std::uint32_t>(m_octets.size());
  if (m_free.empty()) {
    m_octets.emplace_back();
  } else {
    octet = m_free.back();
    m_free.pop_back();
  }
  count(leaf.leaf, -1);
  count(children, 8);
  m_octets[octet].revision = revision;
  m_octets[octet].nodes.fill(Node{children, 0});
  leaf.octet = octet;
  return octet;
}

void StreamTree::removeBelow(Node& node) {
  if (!node.isInner()) return count(node.leaf, -1);
  for (Node& below : m_octets[node.octet].nodes) removeBelow(below);
  m_free.push_back(node.octet);
  node.octet = 0;
}

void StreamTree::setLeaf(Node& node, const StreamLeaf& leaf, std::uint32_t revision) {
  if (node.isInner() && m_octets[node.octet].revision == revision) return;
  removeBelow(node);
  node.leaf = leaf;
  count(leaf, 1);
}

bool StreamTree::apply(const TreePart& part, std::uint32_t revision) {
  reserve();
  if (!part.isOctet) {
    setLeaf(makePlace(part.cell, revision), part.leaves[0], revision);
    return true;
  }
  Node* inner = find(part.cell);
  if (!inner) return false;
  const std::uint32_t octet =
      inner->isInner() ? inner->octet : makeInner(*inner, StreamLeaf(), revision);
  for (int i = 0; i < 8; ++i)
    if (part.mask >> i & 1) setLeaf(m_octets[octet].nodes[i], part.leaves[i], revision);
  return true;
}

SemanticOcTree StreamTree::map(const SemanticOcTree& empty) const {
  SemanticOcTree map(empty);
  if (m_root.isKnown())
    TreeBuilder::fill(map, StreamCursor(*this, m_root), TreeBuilder::Merge::Never);
  return map;
}

}  // namespace semantic_octree
