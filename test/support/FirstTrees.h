#pragma once
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <vector>

/** Per node of a path: the first tree that expands it, or numTrees() if none does. */
inline std::vector<std::size_t> firstTreesOf(const tree_abstraction::AlphaPath& path) {
  std::vector<double> lowest;  // tau in tree k, with a minus: ascending
  for (std::size_t k = 0; k < path.numTrees(); ++k) lowest.push_back(-path.highestAlpha(k));
  std::vector<std::size_t> first;
  for (const double tau : path.tau()) {
    const auto k = std::lower_bound(lowest.begin() + 1, lowest.end(), -tau);
    first.push_back(tau > 0 ? static_cast<std::size_t>(k - lowest.begin()) : path.numTrees());
  }
  return first;
}
