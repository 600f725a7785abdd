#pragma once
#include <semantic_abstraction/AlphaTrees.h>

#include <algorithm>
#include <numeric>
#include <vector>

/** Each of the compressed trees of all alphas, with all nodes in memory: what AlphaTrees is held
 * against. */
struct AllAlphas {
  explicit AllAlphas(const semantic_octree::Abstraction& abstraction) : trees({}) {
    std::vector<double> tau, addedLeaves;
    const auto roots = abstraction.forEachTau([&](const semantic_octree::Abstraction::NodeTau& n) {
      tau.push_back(n.tau);
      addedLeaves.push_back(n.added.leaves);
    });
    trees = tree_abstraction::AlphaPath(tau);
    numRoots = static_cast<std::size_t>(1 + roots.leaves);
    leaves.assign(trees.numTrees() + 1, 0);
    leaves[0] = 1 + roots.leaves;
    for (std::size_t i = 0; i < tau.size(); ++i) leaves[trees.treeOf(tau[i])] += addedLeaves[i];
    leaves.pop_back();  // what no tree expands
    std::partial_sum(leaves.begin(), leaves.end(), leaves.begin());
  }
  /** \param wanted leaves, not less than the roots */
  double alphaForLeaves(std::size_t wanted) const {
    const auto beyond = std::upper_bound(leaves.begin(), leaves.end(), static_cast<double>(wanted));
    return trees.alpha(static_cast<std::size_t>(beyond - leaves.begin()) - 1);
  }

  tree_abstraction::AlphaPath trees;
  std::size_t numRoots;
  std::vector<double> leaves;  ///< of each tree
};
