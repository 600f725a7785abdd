#pragma once
#include <reference/GTreeSearch.h>
#include <tree_abstraction/AbstractionWeights.h>

#include <cstdint>
#include <vector>

/** The optimum by looking at every pruned tree, computed from the joint distribution of leaf and
 * class alone: shares no code with the search. */
namespace brute_force {

struct Optimum {
  std::size_t numTrees = 0, numOptimal = 0;
  /** Largest J over that of the roots alone. */
  double objective = 0;
  /** Interior nodes that all optimal trees have; ascending. */
  std::vector<std::int32_t> inAll;
  /** Some optimal tree has exactly the interior nodes inAll. */
  bool intersectionIsOptimal = false;
};

/** Number of pruned trees: for each root 1 + the product over its children. */
double countTrees(const reference::Forest& tree);

/** J(T) over that of the roots alone for any set of interior nodes that is closed towards the
 * roots. */
double objective(const reference::Forest& tree, const tree_abstraction::AbstractionWeights& weights,
                 const std::vector<std::int32_t>& interior);

/** At most 64 inner nodes. */
Optimum optimize(const reference::Forest& tree,
                 const tree_abstraction::AbstractionWeights& weights);

}  // namespace brute_force
