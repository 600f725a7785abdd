#pragma once
#include <reference/GTreeSearch.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "RandomTrees.h"

/** What the tests of collapseAlphas() and of AlphaPath share. */
namespace path_examples {

using namespace tree_abstraction;
using namespace reference;
using random_trees::Engine;
using random_trees::Shape;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline std::vector<double> tausOf(const SearchResult& found, const AbstractionWeights& weights) {
  return collapseAlphas(found.parents(), found.gains(weights), found.prices());
}

/** Children - 1 of each inner node. */
inline std::vector<double> addedLeaves(const Forest& forest) {
  std::vector<double> added;
  for (const Forest::Node& node : forest.nodes)
    added.push_back(std::max(0.0, static_cast<double>(node.children.size()) - 1));
  return added;
}

/** Nodes the compressed tree of one alpha expands. \param eps what counts as a tie */
inline std::vector<char> expandedAt(const std::vector<double>& tau, double alpha, double eps = 0) {
  std::vector<char> mask;
  for (const double t : tau) mask.push_back(t > alpha + eps);
  return mask;
}

/** A sparse octree searched at alpha = 0. */
struct Example {
  AbstractionWeights weights;
  SearchResult found;
  std::vector<double> tau;

  explicit Example(unsigned seed) {
    Engine random(seed);
    const Shape shape{4, 8, 8, 0.5};
    const Forest forest = random_trees::makeTree(shape, random);
    weights = random_trees::makeWeights(shape, random);
    weights.alpha = 0;
    found = findOptimalTree(forest, weights);
    tau = tausOf(found, weights);
  }
};

}  // namespace path_examples
