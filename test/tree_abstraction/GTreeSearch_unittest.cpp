#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>

#include <algorithm>
#include <cmath>

#include "BruteForce.h"
#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;
using random_trees::Engine;
using random_trees::Shape;

namespace {

constexpr DivergenceForm kForms[] = {DivergenceForm::Stable, DivergenceForm::Fast};

}  // namespace

TEST(GTreeSearch, measuresOfAForestAreThoseOfItsLeavesTheFrameIncluded) {
  Engine random(8);
  Shape shape{2, 4, 4, 0.7};
  shape.numRoots = 5;
  const auto tree = random_trees::makeTree(shape, random);
  const AbstractionWeights weights{{relevant("one", 1, {1})}, 0.01};
  const auto found = findOptimalTree(tree, weights);
  double leafEntropy = 0, left = 0, p = 0;
  for (std::size_t n = 0; n < found.tree.size(); ++n) {
    const double share = found.information.probability[n];
    if (n < 5) p += share * found.tree.row(n)[0];
    if (!found.isOptimalLeaf(n)) continue;
    leafEntropy -= xLogX(share);
    left += share * binaryEntropy(found.tree.row(n)[0]);
  }
  EXPECT_NEAR(found.optimal.leafEntropy, leafEntropy, 1e-14);
  EXPECT_NEAR(found.optimal.information[0], binaryEntropy(p) - left, 1e-14);
  EXPECT_GT(found.roots.information[0], 0.0);
}

TEST(GTreeSearch, findsExactlyNothingInEqualLeavesOfUnequalWeights) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Engine random(seed);
    VectorTree tree(1);
    const auto root = tree.addInner(VectorTree::kNoParent);
    const double p = random_trees::uniform(random);
    for (int i = 0; i < 5; ++i) tree.addLeaf(root, random_trees::uniform(random), {1 - p, p});
    for (const auto form : kForms) {
      const auto found = findOptimalTree(tree, {{relevant("one", 1, {1})}, 0.0}, {form});
      EXPECT_EQ(found.values.v[0], 0.0);
      EXPECT_EQ(found.optimal.numLeaves, 1u);
    }
  }
}

TEST(GTreeSearch, looksAheadBeyondASplitThatDoesNotPayByItself) {
  VectorTree tree(1);
  const auto root = tree.addInner(VectorTree::kNoParent);
  for (int i = 0; i < 8; ++i) {
    const auto block = tree.addInner(root);
    for (int k = 0; k < 8; ++k) tree.addLeaf(block, 1.0, {1.0 - k % 2, 1.0 * (k % 2)});
  }
  const auto found = findOptimalTree(tree, {{relevant("one", 8, {1})}, 1.0});
  EXPECT_EQ(found.information.divergence[0], 0.0);
  EXPECT_EQ(found.interior().size(), 9u);
}

TEST(GTreeSearch, objectiveOfTheLeavesEqualsGAtTheRootInLargeTrees) {
  for (const auto form : kForms) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      Engine random(seed);
      const Shape shape{5, 8, 8, 0.7};
      const auto tree = random_trees::makeTree(shape, random);
      auto weights = random_trees::makeWeights(shape, random);
      weights.alpha *= 0.1;
      const auto found = findOptimalTree(tree, weights, {form});
      ASSERT_GT(found.objective, 0.0);
      EXPECT_NEAR(brute_force::objective(tree, weights, {}), 0.0, 1e-12);
      EXPECT_NEAR(found.optimal.objective(weights), found.objective, 1e-9 * found.objective);
      EXPECT_NEAR(found.values.g[0], found.objective, 1e-12);
    }
  }
}

TEST(GTreeSearch, noSingleExpansionOrCollapseImproves) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Engine random(seed);
    const Shape shape{4, 4, 4, 0.8};
    const auto tree = random_trees::makeTree(shape, random);
    const auto weights = random_trees::makeWeights(shape, random);
    const auto found = findOptimalTree(tree, weights);
    const auto interior = found.interior();
    const double best = brute_force::objective(tree, weights, interior);
    for (const auto leaf : found.leaves()) {
      if (tree.children(leaf).empty()) continue;
      auto more = interior;
      more.push_back(leaf);
      EXPECT_LE(brute_force::objective(tree, weights, more), best + 1e-13);
    }
    for (const auto node : interior) {
      const auto isInterior = [&](auto child) {
        return std::find(interior.begin(), interior.end(), child) != interior.end();
      };
      const auto& children = tree.children(node);
      if (std::any_of(children.begin(), children.end(), isInterior)) continue;
      auto fewer = interior;
      fewer.erase(std::find(fewer.begin(), fewer.end(), node));
      EXPECT_LT(brute_force::objective(tree, weights, fewer), best);
    }
  }
}

TEST(GTreeSearch, randomTreesNeverExceedTheOptimum) {
  Engine random(5);
  const Shape shape{4, 8, 8, 0.5};
  const auto tree = random_trees::makeTree(shape, random);
  const auto weights = random_trees::makeWeights(shape, random);
  const auto found = findOptimalTree(tree, weights);
  for (int i = 0; i < 500; ++i) {
    std::vector<char> expanded(found.tree.size(), false);
    const double probability = random_trees::uniform(random);
    double j = 0;
    for (std::size_t n = 0; n < expanded.size(); ++n) {
      const bool reached = n == 0 || expanded[static_cast<std::size_t>(found.tree.parent[n])];
      expanded[n] = reached && !found.tree.isLeaf(n) && random_trees::uniform(random) < probability;
      if (expanded[n]) j += found.values.gain[n] - weights.alpha * found.values.price[n];
    }
    EXPECT_LE(j, found.objective + 1e-13);
  }
}

TEST(GTreeSearch, keepsTheRootAloneIfRelevanceIsNotWorthItsPrice) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Engine random(seed);
    Shape shape;
    shape.numClasses = 3;
    const auto tree = random_trees::makeTree(shape, random);
    // JS of a variable never exceeds H(Pi), hence beta <= alpha never pays.
    const auto found = findOptimalTree(
        tree, {{relevant("a", 0.5, {1}), relevant("b", 0.5, {2}), irrelevant("c", 1, {3})}, 1.0});
    EXPECT_EQ(found.optimal.numLeaves, 1u);
    EXPECT_EQ(found.objective, 0.0);
  }
}

TEST(GTreeSearch, keepsEverythingInformativeAtNoPrice) {
  Engine random(4);
  const auto tree = random_trees::makeTree({}, random);
  const auto found = findOptimalTree(tree, {{wholeClassVariable("all", 1, 2)}, 0.0});
  EXPECT_EQ(found.optimal.numLeaves, 64u);
  ASSERT_TRUE(found.retention[0].has_value());
  EXPECT_EQ(*found.retention[0], 1.0);
}

TEST(GTreeSearch, reportsNoRetentionOfInformationThatIsNotThere) {
  VectorTree tree(2);
  const auto root = tree.addInner(VectorTree::kNoParent);
  tree.addLeaf(root, 1, {1, 0, 0});
  tree.addLeaf(root, 1, {0, 1, 0});
  const auto found =
      findOptimalTree(tree, {{relevant("there", 1, {1}), relevant("absent", 1, {2})}, 0.1});
  EXPECT_TRUE(found.retention[0].has_value());
  EXPECT_FALSE(found.retention[1].has_value());
}

TEST(GTreeSearch, countsALeafAboveSomethingKnownAsKnown) {
  VectorTree tree(1);
  const auto root = tree.addInner(VectorTree::kNoParent);
  const auto half = tree.addInner(root);
  tree.addLeaf(half, 1, {0.5, 0.5});
  tree.addMissing(half, 1, {0.5, 0.5});
  const auto empty = tree.addInner(root);
  tree.addMissing(empty, 1, {0.5, 0.5});
  const auto found = findOptimalTree(tree, {{relevant("one", 1, {1})}, 1.0});
  EXPECT_EQ(found.full.numLeaves, 3u);
  EXPECT_EQ(found.full.numKnownLeaves, 1u);
  EXPECT_EQ(found.optimal.numKnownLeaves, 1u);
  EXPECT_TRUE(found.tree.known[1]);
  EXPECT_FALSE(found.tree.known[2]);
}

TEST(GTreeSearch, leavesOfTheOptimumCoverTheTreeOnce) {
  Engine random(9);
  const Shape shape{4, 2, 5, 0.7};
  const auto tree = random_trees::makeTree(shape, random);
  const auto found = findOptimalTree(tree, random_trees::makeWeights(shape, random));
  double covered = 0;
  for (std::size_t n = 0; n < found.tree.size(); ++n) {
    if (found.isOptimalLeaf(n)) covered += found.information.probability[n];
  }
  EXPECT_NEAR(covered, 1.0, 1e-14);
  EXPECT_EQ(found.leaves().size(), found.optimal.numLeaves);
}

TEST(GTreeSearch, passesGThroughFrameNodesWithASingleChild) {
  Engine random(2);
  const auto weights = AbstractionWeights{{relevant("one", 1, {1})}, 0.05};
  VectorTree plain(1), framed(1);
  const auto top = framed.addInner(framed.addInner(VectorTree::kNoParent));
  for (auto* tree : {&plain, &framed}) {
    const auto root = tree->addInner(tree == &framed ? top : VectorTree::kNoParent);
    tree->addLeaf(root, 1, {0.9, 0.1});
    tree->addLeaf(root, 1, {0.1, 0.9});
  }
  const auto a = findOptimalTree(plain, weights), b = findOptimalTree(framed, weights);
  EXPECT_EQ(a.objective, b.objective);
  EXPECT_EQ(b.interior().size(), 3u);
}
