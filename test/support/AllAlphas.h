#pragma once
#include <semantic_abstraction/AlphaTrees.h>

#include <vector>

/** Each of the compressed trees of all alphas, with all nodes in memory: what AlphaTrees is held
 * against. */
struct AllAlphas {
  explicit AllAlphas(const semantic_octree::Abstraction& abstraction) : trees({}) {
    std::vector<double> tau;
    const auto roots = abstraction.forEachTau([&](const semantic_octree::Abstraction::NodeTau& n) {
      tau.push_back(n.tau);
      addedLeaves.push_back(n.added.leaves);
    });
    trees = tree_abstraction::AlphaPath(std::move(tau));
    numRoots = static_cast<std::size_t>(1 + roots.leaves);
    leaves = trees.totals(addedLeaves, static_cast<double>(numRoots));
  }
  /** \param wanted leaves, not less than the roots */
  double alphaForLeaves(std::size_t wanted) const {
    return trees.alpha(trees.largestWithin(static_cast<double>(wanted), addedLeaves,
                                           static_cast<double>(numRoots)));
  }

  tree_abstraction::AlphaPath trees;
  std::vector<double> addedLeaves;  ///< by expanding each node
  std::size_t numRoots;
  std::vector<double> leaves;  ///< of each tree
};
