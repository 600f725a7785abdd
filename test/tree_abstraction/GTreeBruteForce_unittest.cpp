// The search for the optimal tree against all trees.
#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>

#include <algorithm>
#include <map>

#include "BruteForce.h"
#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;
using random_trees::Engine;
using random_trees::Shape;

namespace {

/** Checks value and minimality; tells how many optimal trees there are. */
std::size_t expectAgreesWithBruteForce(const Forest& tree, const AbstractionWeights& weights) {
  const auto best = brute_force::optimize(tree, weights);
  EXPECT_EQ(static_cast<double>(best.numTrees), brute_force::countTrees(tree));
  EXPECT_TRUE(best.intersectionIsOptimal);
  const auto found = findOptimalTree(tree, weights);
  EXPECT_NEAR(found.objective, best.objective, 1e-13);
  EXPECT_EQ(found.interior(), best.inAll);
  const double j = found.optimal.objective(weights) - found.roots.objective(weights);
  EXPECT_NEAR(j, best.objective, 1e-13);
  return best.numOptimal;
}

struct Tally {
  int trees = 0, withTies = 0, expandedPartly = 0;
};

/** Trees of this shape that brute force can manage, one a seed. */
Tally checkShape(const Shape& shape, int numSeeds) {
  Tally tally;
  for (int seed = 1; seed <= numSeeds; ++seed) {
    SCOPED_TRACE(seed);
    Engine random(static_cast<unsigned>(seed));
    const auto tree = random_trees::makeTree(shape, random);
    const auto weights = random_trees::makeWeights(shape, random);
    if (brute_force::countTrees(tree) > 2e5) continue;
    ++tally.trees;
    if (expectAgreesWithBruteForce(tree, weights) > 1) ++tally.withTies;
    const auto found = findOptimalTree(tree, weights);
    const auto count = found.optimal.numLeaves;
    if (count > tree.roots.size() && count < found.full.numLeaves) ++tally.expandedPartly;
  }
  return tally;
}

TEST(GTreeSearch, agreesWithBruteForce) {
  struct Case {
    const char* name;
    Shape shape;
    int seeds, trees, withTies, expandedPartly;  ///< at least
  };
  const Case cases[] = {
      {"full quadtrees", {}, 25, 25, 0, 8},
      {"quadtrees full of ties", {3, 4, 4, 0.8, 0.0, 1, 1, true}, 300, 300, 40, 0},
      {"sparse octrees of depth two", {2, 8, 8, 0.6, 0.4, 3}, 200, 200, 0, 20},
      {"sparse octrees of depth three", {3, 8, 8, 0.3, 0.3}, 150, 80, 0, 20},
      {"octrees full of ties, children missing", {3, 8, 8, 0.25, 0.2, 1, 1, true}, 150, 1, 5, 0},
      {"ternary trees", {3, 3, 3, 0.9}, 60, 1, 0, 20},
      {"trees of mixed arity", {4, 1, 4, 0.6, 0.2}, 120, 1, 0, 30},
      {"forests whose frame is free", {2, 4, 4, 0.7, 0.0, 2, 3}, 80, 1, 0, 20}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Tally tally = checkShape(c.shape, c.seeds);
    EXPECT_GE(tally.trees, c.trees);
    EXPECT_GE(tally.withTies, c.withTies);
    EXPECT_GE(tally.expandedPartly, c.expandedPartly);
  }
}

/** G(n) of the paper, not divided by p(n): the most that subtrees of n add to J. From the values of
 * whole trees alone. \param above the interior nodes on the way to n */
double unnormalizedG(const Forest& tree, const AbstractionWeights& weights, std::int32_t node,
                     std::vector<std::int32_t> above, std::map<std::int32_t, double>& all) {
  if (tree[node].children.empty()) return all[node] = 0;
  const double without = brute_force::objective(tree, weights, above);
  above.push_back(node);
  double value = brute_force::objective(tree, weights, above) - without;
  for (const auto child : tree[node].children)
    value += unnormalizedG(tree, weights, child, above, all);
  return all[node] = std::max(value, 0.0);
}

}  // namespace

/** Proposition 1: what is expanded may be decided without p(n), by the children's shares alone. */
TEST(GTreeSearch, gIsPositiveWhereGPerUnitOfProbabilityIs) {
  int positive = 0, zero = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Engine random(seed);
    Shape shape{3, 8, 8, 0.5};
    shape.missingProbability = 0.3;
    const auto tree = random_trees::makeTree(shape, random);
    const auto weights = random_trees::makeWeights(shape, random);
    const auto found = findOptimalTree(tree, weights);
    std::map<std::int32_t, double> g;
    unnormalizedG(tree, weights, tree.roots.front(), {}, g);
    for (const auto& [n, whole] : g) {
      const NodeValues& values = found.values[static_cast<std::size_t>(n)];
      EXPECT_NEAR(whole, values.probability * values.g, 1e-13);
      if (values.probability <= 1e-4 || tree[n].children.empty()) continue;
      if (values.g > 0 && values.g < 1e-6) continue;  // brute force rounds
      EXPECT_EQ(whole > 1e-12, values.g > 0);
      ++(values.g > 0 ? positive : zero);
    }
  }
  EXPECT_GT(positive, 100);
  EXPECT_GT(zero, 100);
}

TEST(GTreeSearch, countsALeafAboveSomethingKnownAsKnown) {
  Forest tree;
  const auto root = tree.addInner(Forest::kNoParent);
  const auto half = tree.addInner(root);
  tree.addLeaf(half, 1, {0.5, 0.5});
  tree.addMissing(half, 1, {0.5, 0.5});
  const auto empty = tree.addInner(root);
  tree.addMissing(empty, 1, {0.5, 0.5});
  const auto found = findOptimalTree(tree, {{relevant("one", 1, {1})}, 1.0});
  EXPECT_EQ(found.full.numLeaves, 3u);
  EXPECT_EQ(found.full.numKnownLeaves, 1u);
  EXPECT_EQ(found.optimal.numKnownLeaves, 1u);
}
