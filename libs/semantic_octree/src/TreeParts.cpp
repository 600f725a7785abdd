#include "TreeParts.h"

#include <algorithm>

namespace semantic_octree {
namespace {

/** Of inner nodes, asked for in the order of a walk depth first. */
class Steps {
 public:
  Steps(const Abstraction& abstraction, const std::vector<std::size_t>& firstTrees) {
    std::size_t i = 0;
    abstraction.forEachPathNode([&](const Abstraction::PathNode& n, const std::vector<double>&) {
      if (!n.isFree) m_steps.push_back({CellPath::of(n.lowest, n.depth), firstTrees[i++]});
    });
  }
  std::size_t of(const CellPath& cell) {
    while (m_next + 1 < m_steps.size() && m_steps[m_next].cell < cell) ++m_next;
    return m_steps[m_next].step;
  }

 private:
  struct Step {
    CellPath cell;
    std::size_t step;
  };
  std::vector<Step> m_steps;
  std::size_t m_next = 0;
};

/** What a receiver has of a cube. */
struct Before {
  /** Part: of a larger leaf. */
  enum class Kind { None, Leaf, Inner, Part };
  Kind kind = Kind::None;
  const StreamTree::Node* node = nullptr;  ///< leaf or inner node

  static Before of(const StreamTree::Node& node) {
    if (!node.isKnown()) return {};
    return {node.isInner() ? Kind::Inner : Kind::Leaf, &node};
  }
  Before child(const StreamTree& tree, int i) const {
    if (kind == Kind::Inner) return of(tree.child(*node, i));
    return {kind == Kind::None ? Kind::None : Kind::Part, nullptr};
  }
  bool isNode() const { return kind == Kind::Leaf || kind == Kind::Inner; }
  bool isLeafOf(const StreamLeaf& leaf) const { return kind == Kind::Leaf && node->leaf == leaf; }
};

class Comparison {
 public:
  Comparison(const SemanticOcTree& map, const Abstraction& abstraction, const StreamTree& before,
             Steps steps)
      : m_map(map),
        m_abstraction(abstraction),
        m_before(before),
        m_steps(std::move(steps)),
        m_rootDepth(abstraction.rootDepth()) {}

  std::vector<OrderedPart> parts() {
    compare(m_map.root(), CellPath(), Before::of(m_before.root()));
    std::stable_sort(m_parts.begin(), m_parts.end(),
                     [](const OrderedPart& a, const OrderedPart& b) { return a.step < b.step; });
    return std::move(m_parts);
  }

 private:
  bool isInner(const Node& node) const { return node && m_abstraction.isExpanded(node); }
  StreamLeaf leafOf(const Node& node) const {
    return node ? StreamLeaf::of(contentOf(m_map, node)) : StreamLeaf();
  }

  /** At the depth of the roots and above. */
  void compare(const Node& node, const CellPath& cell, const Before& before) {
    const bool inner = isInner(node);
    if (inner && cell.depth < m_rootDepth) {
      for (int i = 0; i < 8; ++i) compare(node.child(i), cell.child(i), before.child(m_before, i));
    } else if (inner) {
      if (!before.isNode()) addLeaf(cell, leafOf(node));
      compareOctet(node, cell, before, 0);
    } else if (node || before.kind != Before::Kind::None) {
      const StreamLeaf leaf = leafOf(node);
      if (!before.isLeafOf(leaf)) addLeaf(cell, leaf);
    }
  }

  void addLeaf(const CellPath& cell, const StreamLeaf& leaf) {
    OrderedPart ordered;
    ordered.part.cell = cell;
    ordered.part.leaves[0] = leaf;
    m_parts.push_back(ordered);
  }

  /** \param stepAbove of the node's parent */
  void compareOctet(const Node& node, const CellPath& cell, const Before& before,
                    std::size_t stepAbove) {
    OrderedPart ordered;
    ordered.part.cell = cell;
    ordered.part.isOctet = true;
    ordered.part.mask = 0;
    ordered.step = m_steps.of(cell);
    ordered.begins = stepAbove < ordered.step;
    const bool wasInner = before.kind == Before::Kind::Inner;
    for (int i = 0; i < 8; ++i) {
      const Node child = node.child(i);
      const Before was = wasInner ? before.child(m_before, i) : Before();
      if (isInner(child) ? was.isNode() : !child && was.kind == Before::Kind::None) continue;
      ordered.part.leaves[i] = leafOf(child);
      const bool isSame = !isInner(child) && was.isLeafOf(ordered.part.leaves[i]);
      ordered.part.mask |= static_cast<std::uint8_t>(!isSame << i);
    }
    if (ordered.part.mask != 0) m_parts.push_back(ordered);
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i); isInner(child))
        compareOctet(child, cell.child(i), wasInner ? before.child(m_before, i) : Before(),
                     ordered.step);
  }

  const SemanticOcTree& m_map;
  const Abstraction& m_abstraction;
  const StreamTree& m_before;
  Steps m_steps;
  int m_rootDepth;
  std::vector<OrderedPart> m_parts;
};

}  // namespace

TreeParts partsOfChange(SemanticOcTree& map, const StreamTree& before) {
  const Abstraction abstraction(map);
  TreeParts result;
  const tree_abstraction::AlphaPath trees = abstraction.alphaPath().trees;
  for (std::size_t k = 0; k < trees.numTrees(); ++k) {
    result.alphas.push_back(trees.alpha(k));
    result.ties.push_back(trees.highestAlpha(k));
  }
  // Also of what rounding alone expands.
  result.alphas.push_back(abstraction.options().weights.alpha);
  result.ties.push_back(result.alphas.back());
  result.parts =
      Comparison(map, abstraction, before, Steps(abstraction, trees.firstTrees())).parts();
  return result;
}

}  // namespace semantic_octree
