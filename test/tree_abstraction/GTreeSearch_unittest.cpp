#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>

using namespace tree_abstraction;
using namespace reference;

TEST(GTreeSearch, looksAheadBeyondASplitThatDoesNotPayByItself) {
  Forest tree;
  const auto root = tree.addInner(Forest::kNoParent);
  for (int i = 0; i < 8; ++i) {
    const auto block = tree.addInner(root);
    for (int k = 0; k < 8; ++k) tree.addLeaf(block, 1.0, {1.0 - k % 2, 1.0 * (k % 2)});
  }
  const auto found = findOptimalTree(tree, {{relevant("one", 8, {1})}, 1.0});
  EXPECT_NEAR(found.values[0].divergence[0], 0.0, 1e-15);
  EXPECT_EQ(found.interior().size(), 9u);
}

TEST(GTreeSearch, reportsNoRetentionOfInformationThatIsNotThere) {
  Forest tree;
  const auto root = tree.addInner(Forest::kNoParent);
  tree.addLeaf(root, 1, {1, 0, 0});
  tree.addLeaf(root, 1, {0, 1, 0});
  const auto found =
      findOptimalTree(tree, {{relevant("there", 1, {1}), relevant("absent", 1, {2})}, 0.1});
  EXPECT_TRUE(found.retention(0).has_value());
  EXPECT_FALSE(found.retention(1).has_value());
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
