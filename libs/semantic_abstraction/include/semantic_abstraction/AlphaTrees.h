#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <tree_abstraction/AlphaPath.h>

#include <functional>
#include <vector>

namespace semantic_octree {

/** The compressed trees of all alphas, for one set of weights, of a map that may be larger than
 * memory. Its nodes are counted by tau (tree_abstraction::collapseAlphas()) in bins 0.2 % wide.
 *
 * Tree k expands the nodes of the first k bins. The trees between two of these are found by another
 * look at the nodes of one bin. */
class AlphaTrees {
 public:
  using Visit = std::function<void(double tau, const AddedToTree&)>;
  /** Calls visit(tau, what expanding it adds) for all nodes that have a price, in any order, at
   * each call alike. \return what the tree has that expands none of them */
  using Nodes = std::function<AddedToTree(const Visit&)>;

  explicit AlphaTrees(Nodes nodes);
  /** For the present weights and regions. The abstraction must outlive it; the map must not change.
   */
  explicit AlphaTrees(const Abstraction& abstraction);

  std::size_t numTrees() const { return m_trees.size(); }
  /** What a tree has; tree 0 are the roots alone, the last one is that of alpha = 0. */
  const AddedToTree& tree(std::size_t k) const { return m_trees[k]; }
  /** All that the map has. */
  const AddedToTree& full() const { return m_full; }
  /** An alpha of tree k, as tree_abstraction::AlphaPath has it. */
  double alpha(std::size_t k) const;

  /** Alpha of the largest tree with at most this many known leaves.
   * \throw std::invalid_argument fewer than the roots, or more than the map has. */
  double alphaForLeaves(std::size_t wanted) const;
  /** Alpha of the largest tree that fits, where larger trees than one that does not fit do not fit
   * either: by bisection. \param fits called with alphas; tree 0 is taken to fit */
  double largestThat(const std::function<bool(double alpha)>& fits) const;

 private:
  /** Nodes whose taus are next to each other. */
  struct Bin {
    double highest = 0, lowest = 0;
    AddedToTree added;
  };
  /** The trees from tree k to the next. */
  struct Path {
    tree_abstraction::AlphaPath trees;
    std::size_t first, last;          ///< the path's tree that is tree k, and the next
    std::vector<double> addedLeaves;  ///< by each tree of the path to the one before
  };
  void mergeTies();
  Path within(std::size_t k) const;

  Nodes m_nodes;
  std::vector<Bin> m_bins;  ///< highest taus first
  std::vector<AddedToTree> m_trees;
  AddedToTree m_full;
};

}  // namespace semantic_octree
