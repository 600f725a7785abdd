#pragma once
#include <semantic_abstraction/Abstraction.h>

#include <vector>

namespace semantic_map_compress {

/** What expanding nodes adds to a tree. */
struct Added {
  double leaves = 0;
  /** Information of the terms of either sign, times what their weights are worth, nats. */
  double relevant = 0, irrelevant = 0;

  Added& operator+=(const Added& o);
};

/** The compressed trees of all alphas, for the present weights, of a map that may be larger than
 * memory: its nodes, counted by tau, the alpha from which on they are no longer expanded, in bins
 * 0.2 % wide.
 *
 * Tree k expands the nodes of the first k bins. Between it and the next are those of within(k). */
class AlphaBins {
 public:
  explicit AlphaBins(const semantic_octree::Abstraction& abstraction);

  std::size_t numTrees() const { return m_bins.size() + 1; }
  /** What a tree has; tree 0 are the roots alone. */
  const Added& tree(std::size_t k) const { return m_trees[k]; }
  /** All that the map has. */
  const Added& full() const { return m_full; }
  /** An alpha of tree k, as tree_abstraction::AlphaPath has it. */
  double alpha(std::size_t k) const;

  /** The trees from tree k to the next. */
  struct Path {
    tree_abstraction::AlphaPath trees;
    std::size_t first, last;          ///< the path's tree that is tree k, and the next
    std::vector<double> addedLeaves;  ///< to tree k, by each node of the path
  };
  Path within(std::size_t k) const;

 private:
  /** Nodes whose taus are next to each other. */
  struct Bin {
    double highest = 0, lowest = 0;
    Added added;
  };
  void mergeTies();

  const semantic_octree::Abstraction& m_abstraction;
  std::vector<Bin> m_bins;  ///< highest taus first
  std::vector<Added> m_trees;
  Added m_full;
};

}  // namespace semantic_map_compress
