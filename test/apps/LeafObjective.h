#pragma once
#include <semantic_abstraction/Abstraction.h>

#include <functional>
#include <vector>

/** The objective of pruned trees of a map, computed from their leaves alone: from the volume of
 * each leaf and its classes' probabilities, without any G-value or divergence.
 *
 * For yes-or-no terms, unknown space as a class of its own, a free frame and no regions. */
class LeafObjective {
 public:
  /** \param map keeps G-values */
  explicit LeafObjective(semantic_octree::SemanticOcTree& map);

  /** A node inside a block; missing children are nodes too. */
  struct Item {
    double weight = 0;                  ///< p(n)
    std::vector<double> probabilities;  ///< of each term
    std::vector<std::size_t> children;  ///< indices below this one's; none: a leaf of the map
    bool isExpanded = false;            ///< in the optimal tree, if all above are
  };
  const std::vector<Item>& items() const { return m_items; }
  const std::vector<std::size_t>& blocks() const { return m_blocks; }

  /** What a node contributes to J as a leaf. */
  double asLeaf(const Item& item) const;
  /** J of a tree over that of the blocks alone. \param isExpanded index -> whether its children are
   * in the tree, if it is; asked for inner nodes only */
  double objective(const std::function<bool(std::size_t)>& isExpanded) const;
  /** Contribution of what is below a node. */
  double below(std::size_t item, const std::function<bool(std::size_t)>& isExpanded) const;

 private:
  using Node = semantic_octree::SemanticOcTree::Node;
  std::size_t add(const Node& node, const Node& compressed, unsigned depth);
  void visitFrame(const Node& node, const Node& compressed, unsigned depth);
  void normalize();

  semantic_octree::SemanticOcTree& m_map;
  const semantic_octree::SemanticOcTree m_compressed;
  const semantic_octree::AbstractionOptions m_options;
  unsigned m_blockDepth;
  std::vector<Item> m_items;
  std::vector<std::size_t> m_blocks;
};
