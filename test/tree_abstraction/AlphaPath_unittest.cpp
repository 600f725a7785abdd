#include <gtest/gtest.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <cmath>

#include "PathExamples.h"

using namespace path_examples;

namespace {

std::size_t count(const std::vector<char>& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), char{true}));
}

}  // namespace

TEST(AlphaPath, treesAreNestedAndEachIsTheOptimumAtItsAlpha) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Engine random(seed);
    const Shape shape{3, 8, 8, 0.5};
    const auto tree = random_trees::makeTree(shape, random);
    auto weights = random_trees::makeWeights(shape, random);
    weights.alpha = 0;
    const AlphaPath path(tausOf(findOptimalTree(tree, weights), weights));
    ASSERT_GT(path.numTrees(), 3u);
    EXPECT_EQ(count(path.expanded(0)), 0u);
    EXPECT_EQ(path.highestAlpha(0), kInfinity);
    EXPECT_EQ(path.lowestAlpha(path.numTrees() - 1), 0.0);
    for (std::size_t k = 0; k < path.numTrees(); ++k) {
      EXPECT_LT(path.lowestAlpha(k), path.highestAlpha(k));
      weights.alpha = path.alpha(k);
      EXPECT_EQ(path.expanded(k), findOptimalTree(tree, weights).expanded());
      if (k == 0) continue;
      EXPECT_EQ(path.highestAlpha(k), path.lowestAlpha(k - 1));
      const auto smaller = path.expanded(k - 1), larger = path.expanded(k);
      EXPECT_LT(count(smaller), count(larger));
      for (std::size_t n = 0; n < larger.size(); ++n) EXPECT_LE(smaller[n], larger[n]);
    }
  }
}

TEST(AlphaPath, totalsCountLeavesAndInformationAlongThePath) {
  const Example example(6);
  const AlphaPath path(example.tau);
  const auto leaves = path.totals(addedLeaves(example.found.forest), 1.0);
  const auto entropies = path.totals(example.found.prices(), 0.0);
  for (std::size_t k = 0; k < path.numTrees(); k += 7) {
    const auto measures = measuresOf(example.found, example.weights, path.expanded(k));
    EXPECT_EQ(leaves[k], static_cast<double>(measures.numLeaves));
    EXPECT_NEAR(entropies[k], measures.leafEntropy, 1e-12);
  }
}

TEST(AlphaPath, givesTheLargestTreeWithinAWantedNumberOfLeaves) {
  const Example example(7);
  const AlphaPath path(example.tau);
  const auto added = addedLeaves(example.found.forest);
  const auto leaves = path.totals(added, 1.0);
  const std::size_t all = example.found.full.numLeaves;
  for (std::size_t wanted = 1; wanted <= all; ++wanted) {
    const std::size_t k = path.largestWithin(static_cast<double>(wanted), added, 1);
    EXPECT_LE(leaves[k], static_cast<double>(wanted));
    if (k + 1 < path.numTrees()) {
      EXPECT_GT(leaves[k + 1], static_cast<double>(wanted));
    }
  }
}

TEST(AlphaPath, aBudgetOfBytesMayExceedTheWholeTreeButNotFallBelowTheRoots) {
  const AlphaPath path({3, 2, 2, 1, 0, -1});
  const std::vector<double> bytes{10, 5, 5, 20, 100, 100};
  ASSERT_EQ(path.numTrees(), 4u);
  EXPECT_EQ(path.largestWithin(4, bytes, 4), 0u);
  EXPECT_EQ(path.largestWithin(14, bytes, 4), 1u);
  EXPECT_EQ(path.largestWithin(23, bytes, 4), 1u);  // the two of tau 2 come together
  EXPECT_EQ(path.largestWithin(24, bytes, 4), 2u);
  EXPECT_EQ(path.largestWithin(1e9, bytes, 4), 3u);
  EXPECT_EQ(path.expanded(3), (std::vector<char>{1, 1, 1, 1, 0, 0}));
  EXPECT_THROW(path.largestWithin(3, bytes, 4), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(kNan, bytes, 4), std::invalid_argument);
}

TEST(AlphaPath, rejectsCostsThatDoNotFit) {
  const AlphaPath path({3, 2});
  EXPECT_THROW(path.totals({1}, 0), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(5, {1, -1}, 1), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(5, {1, kNan}, 1), std::invalid_argument);
  EXPECT_THROW(path.largestWithin(1, {1, 1, 1}, 1), std::invalid_argument);
  EXPECT_THROW(path.expanded(3), std::out_of_range);
  EXPECT_THROW(AlphaPath({1, kNan}), std::invalid_argument);
}

TEST(AlphaPath, tausThatDifferByRoundingComeTogether) {
  const AlphaPath path({1.0, 1.0 + 1e-15, 1.0 - 1e-15, 0.5});
  EXPECT_EQ(path.numTrees(), 3u);
  EXPECT_EQ(count(path.expanded(1)), 3u);
}

TEST(AlphaPath, treesThatAreFreeAreOptimalAtEveryFiniteAlpha) {
  const AlphaPath path({kInfinity, 2.0});
  ASSERT_EQ(path.numTrees(), 3u);
  EXPECT_EQ(path.alpha(0), kInfinity);
  EXPECT_EQ(path.lowestAlpha(1), 2.0);
  EXPECT_GT(path.alpha(1), 2.0);
  EXPECT_TRUE(std::isfinite(path.alpha(1)));
  EXPECT_EQ(path.alpha(2), 1.0);
}

TEST(AlphaPath, aTreeThatNeverPaysIsItsRoot) {
  const AlphaPath path({-1.0, -kInfinity});
  EXPECT_EQ(path.numTrees(), 1u);
  EXPECT_GT(path.alpha(0), 0.0);
  EXPECT_EQ(count(path.expanded(0)), 0u);
}
