#include "TreeParts.h"

#include <algorithm>
#include <tuple>

namespace semantic_octree {

void PartList::add(const TreePart& part, std::size_t step, bool begins) {
  if (m_chunks.empty() || m_chunks.back().bytes.size() > kChunk) {
    m_chunks.emplace_back();
    m_chunks.back().bytes.reserve(kChunk + kMostOfPart);
  }
  ByteWriter& chunk = m_chunks.back();
  m_entries.push_back({part.cell.path, static_cast<std::uint32_t>(step),
                       static_cast<std::uint32_t>(m_chunks.size() - 1),
                       static_cast<std::uint32_t>(chunk.bytes.size()),
                       static_cast<std::uint8_t>(part.cell.depth), part.mask, part.isOctet,
                       begins});
  forEachLeaf(part, [&](const StreamLeaf& leaf) { put(chunk, leaf); });
}

void PartList::sort() {
  const auto key = [](const Entry& e) { return std::tuple(e.step, e.chunk, e.at); };
  std::sort(m_entries.begin(), m_entries.end(),
            [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
}

TreePart PartList::part(std::size_t i) const {
  const Entry& e = m_entries[i];
  TreePart part;
  part.cell = {e.path, e.depth};
  part.isOctet = e.isOctet;
  part.mask = e.mask;
  ByteReader chunk(m_chunks[e.chunk].bytes, e.at);
  forEachLeaf(part, [&](StreamLeaf& leaf) { get(chunk, leaf); });
  return part;
}

namespace {

/** When inner nodes of the compressed tree come in: asked for in the order of a walk depth first.
 */
class Steps {
 public:
  explicit Steps(const Abstraction& abstraction) : m_steps(stepsOf(abstraction)) {}

  std::size_t of(const CellPath& cell) {
    while (m_next + 1 < m_tau.size() && cellOf(m_next) < cell) ++m_next;
    return m_steps.treeOf(m_tau[m_next]);
  }
  const tree_abstraction::AlphaPath& alphas() const { return m_steps; }

 private:
  /** Fills m_tau and m_cells, too. */
  tree_abstraction::AlphaPath stepsOf(const Abstraction& abstraction) {
    std::vector<double> all;
    abstraction.forEachTau([&](const Abstraction::NodeTau& n) {
      if (n.tau > 0) all.push_back(n.tau);
      if (!n.isExpanded) return;
      m_tau.push_back(n.tau);
      const CellPath cell = CellPath::of(n);
      m_cells.push_back(cell.path << kDepthBits | static_cast<unsigned>(cell.depth));
    });
    return {std::move(all), m_tau};
  }
  CellPath cellOf(std::size_t i) const {
    constexpr std::uint64_t kDepths = (1 << kDepthBits) - 1;
    return {m_cells[i] >> kDepthBits, static_cast<int>(m_cells[i] & kDepths)};
  }

  static constexpr int kDepthBits = 5;
  std::vector<double> m_tau;
  std::vector<std::uint64_t> m_cells;  ///< path and depth
  std::size_t m_next = 0;
  tree_abstraction::AlphaPath m_steps;
};

/** A leaf's needs no classes. */
StreamLeaf leafOf(const Node& leaf) { return contentOf(leaf, 0); }

/** What a receiver has of a cube. */
struct Before {
  /** Part: of a larger leaf. */
  enum class Kind { None, Leaf, Inner, Part };
  Kind kind = Kind::None;
  Node node;  ///< leaf or inner node

  static Before of(const Node& node) {
    if (!node) return {};
    return {node.isLeaf() ? Kind::Leaf : Kind::Inner, node};
  }
  Before child(int i) const {
    if (kind == Kind::Inner) return of(node.child(i));
    return {kind == Kind::None ? Kind::None : Kind::Part, {}};
  }
  bool isNode() const { return kind == Kind::Leaf || kind == Kind::Inner; }
  bool is(const StreamLeaf& leaf) const { return kind == Kind::Leaf && leafOf(node) == leaf; }
};

struct CompressedMap {
  const SemanticOcTree& map;
  const Abstraction& abstraction;

  bool isInner(const Node& node) const { return node && abstraction.isExpanded(node); }
  StreamLeaf leafOf(const Node& node) const {
    return node ? StreamLeaf(contentOf(node, map.numClasses())) : StreamLeaf();
  }
};

/** A tree as it was told. */
struct ToldTree {
  bool isInner(const Node& node) const { return node && !node.isLeaf(); }
  /** Where an inner node will be there is any leaf before; the last one again takes least. */
  StreamLeaf leafOf(const Node& node) {
    if (!node) return {};
    if (node.isLeaf()) m_last = semantic_octree::leafOf(node);
    return m_last;
  }

 private:
  StreamLeaf m_last = LeafContent();
};

/** What leads to a tree from what was there before. */
template <class Tree>
class Comparison {
 public:
  /** \param steps null: all parts are of one \param changed null: anywhere */
  Comparison(Tree tree, int rootDepth, Steps* steps, const ChangedCells* changed, PartList& parts)
      : m_tree(std::move(tree)),
        m_rootDepth(rootDepth),
        m_steps(steps),
        m_changed(changed),
        m_parts(parts) {}

  void run(const Node& root, const Node& before) { compare(root, CellPath(), Before::of(before)); }

 private:
  bool isInner(const Node& node) const { return m_tree.isInner(node); }
  bool mayDiffer(const CellPath& cell) const { return !m_changed || m_changed->touch(cell); }

  /** At the depth of the roots and above. */
  void compare(const Node& node, const CellPath& cell, const Before& before) {
    if (!mayDiffer(cell)) return;
    const bool inner = isInner(node);
    if (inner && cell.depth < m_rootDepth) {
      for (int i = 0; i < 8; ++i) compare(node.child(i), cell.child(i), before.child(i));
    } else if (inner) {
      if (!before.isNode()) addLeaf(cell, m_tree.leafOf(node));
      compareOctet(node, cell, before, 0);
    } else if (node || before.kind != Before::Kind::None) {
      const StreamLeaf leaf = m_tree.leafOf(node);
      if (!before.is(leaf)) addLeaf(cell, leaf);
    }
  }

  void addLeaf(const CellPath& cell, const StreamLeaf& leaf) {
    TreePart part;
    part.cell = cell;
    part.leaves[0] = leaf;
    m_parts.add(part, 0, true);
  }

  /** \param stepAbove of the node's parent */
  void compareOctet(const Node& node, const CellPath& cell, const Before& before,
                    std::size_t stepAbove) {
    TreePart part;
    part.cell = cell;
    part.isOctet = true;
    part.mask = 0;
    const std::size_t step = m_steps ? m_steps->of(cell) : 0;
    const bool wasInner = before.kind == Before::Kind::Inner;
    for (int i = 0; i < 8; ++i) {
      const Node child = node.child(i);
      if (!mayDiffer(cell.child(i))) continue;
      const Before was = wasInner ? before.child(i) : Before();
      if (isInner(child) ? was.isNode() : !child && was.kind == Before::Kind::None) continue;
      part.leaves[i] = m_tree.leafOf(child);
      const bool isSame = !isInner(child) && was.is(part.leaves[i]);
      part.mask |= static_cast<std::uint8_t>(!isSame << i);
    }
    if (part.mask != 0) m_parts.add(part, step, stepAbove < step);
    for (int i = 0; i < 8; ++i)
      if (const Node child = node.child(i); isInner(child) && mayDiffer(cell.child(i)))
        compareOctet(child, cell.child(i), wasInner ? before.child(i) : Before(), step);
  }

  Tree m_tree;
  int m_rootDepth;
  Steps* m_steps;
  const ChangedCells* m_changed;
  PartList& m_parts;
};

}  // namespace

ChangedCells::ChangedCells(std::vector<CellPath> cells) {
  std::sort(cells.begin(), cells.end());
  for (const CellPath& cell : cells) {
    const std::uint64_t begin = cell.first(), end = begin + cell.size();
    if (!m_ranges.empty() && begin <= m_ranges.back().second)
      m_ranges.back().second = std::max(m_ranges.back().second, end);
    else
      m_ranges.emplace_back(begin, end);
  }
}

bool ChangedCells::touch(const CellPath& cell) const {
  const std::uint64_t begin = cell.first();
  const auto endsLater = std::partition_point(m_ranges.begin(), m_ranges.end(),
                                              [&](const auto& r) { return r.second <= begin; });
  return endsLater != m_ranges.end() && endsLater->first < begin + cell.size();
}

TreeParts partsOfChange(SemanticOcTree& map, const StreamTree& before) {
  const Abstraction abstraction(map);
  Steps steps(abstraction);
  TreeParts result;
  for (std::size_t step = 0; step < steps.alphas().numTrees(); ++step) {
    result.alphas.push_back(steps.alphas().alpha(step));
    result.ties.push_back(steps.alphas().highestAlpha(step));
  }
  // The tree of alpha also has what rounding alone expands.
  result.alphas.push_back(abstraction.options().weights.alpha);
  result.ties.push_back(result.alphas.back());
  Comparison(CompressedMap{map, abstraction}, abstraction.rootDepth(), &steps, nullptr,
             result.parts)
      .run(map.root(), before.root());
  result.parts.sort();
  return result;
}

TreeParts unorderedPartsOfChange(SemanticOcTree& map, const StreamTree& before,
                                 const ChangedCells* changed) {
  TreeParts result;
  const Abstraction abstraction(map);
  Comparison(CompressedMap{map, abstraction}, abstraction.rootDepth(), nullptr, changed,
             result.parts)
      .run(map.root(), before.root());
  return result;
}

TreeParts partsOf(const StreamTree& tree, int rootDepth) {
  TreeParts result;
  Comparison(ToldTree(), rootDepth, nullptr, nullptr, result.parts).run(tree.root(), {});
  return result;
}

}  // namespace semantic_octree
