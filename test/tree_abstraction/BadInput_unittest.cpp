#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>
#include <reference/VectorTree.h>

#include <limits>

using namespace tree_abstraction;
using namespace reference;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const AbstractionWeights kWeights{{relevant("one", 1, {1})}, 0.1};

/** Message with which the search rejects a tree with this one leaf beside a good one. */
std::string rejection(double weight, const std::vector<double>& distribution) {
  VectorTree tree(1);
  const auto root = tree.addInner(VectorTree::kNoParent);
  tree.addLeaf(root, 1.0, {0.5, 0.5});
  tree.addLeaf(root, weight, distribution);
  try {
    findOptimalTree(tree, kWeights);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expectRejected(double weight, const std::vector<double>& p, const std::string& word) {
  const std::string message = rejection(weight, p);
  EXPECT_NE(message.find("leaf 2"), std::string::npos) << message;
  EXPECT_NE(message.find(word), std::string::npos) << message;
}

}  // namespace

TEST(BadInput, leavesWithBadWeightsAreNamed) {
  EXPECT_EQ(rejection(0.0, {0.5, 0.5}), "");
  expectRejected(-1.0, {0.5, 0.5}, "weight is -1");
  expectRejected(kNan, {0.5, 0.5}, "weight is nan");
  expectRejected(std::numeric_limits<double>::infinity(), {0.5, 0.5}, "weight is inf");
}

TEST(BadInput, leavesWithBadDistributionsAreNamed) {
  expectRejected(1.0, {1.0}, "distribution of 1 classes, expected 2");
  expectRejected(1.0, {0.5, 0.25, 0.25}, "distribution of 3 classes, expected 2");
  expectRejected(1.0, {1.5, -0.5}, "class 1 is -0.5");
  expectRejected(1.0, {kNan, 1.0}, "class 0 is nan");
  expectRejected(1.0, {0.5, 0.4}, "sum to 0.9");
}

TEST(BadInput, aTreeWithoutWeightHasNoOptimum) {
  VectorTree tree(1);
  EXPECT_THROW(findOptimalTree(tree, kWeights), std::invalid_argument);
  tree.addLeaf(VectorTree::kNoParent, 0.0, {0.5, 0.5});
  EXPECT_THROW(findOptimalTree(tree, kWeights), std::invalid_argument);
}

TEST(BadInput, badWeightsAreRejectedBeforeTheSearch) {
  VectorTree tree(1);
  tree.addLeaf(VectorTree::kNoParent, 1.0, {0.5, 0.5});
  EXPECT_THROW(findOptimalTree(tree, {{relevant("two", 1, {2})}, 0.1}), std::invalid_argument);
  EXPECT_THROW(findOptimalTree(tree, {{relevant("one", 1, {1})}, kNan}), std::invalid_argument);
}

TEST(BadInput, vectorTreesRejectParentsThatAreNotInnerNodes) {
  EXPECT_THROW(VectorTree(-1), std::invalid_argument);
  VectorTree tree(1);
  const auto leaf = tree.addLeaf(VectorTree::kNoParent, 1.0, {0.5, 0.5});
  EXPECT_THROW(tree.addInner(leaf), std::invalid_argument);
  EXPECT_THROW(tree.addLeaf(1, 1.0, {0.5, 0.5}), std::invalid_argument);
  EXPECT_THROW(tree.addMissing(-2, 1.0, {0.5, 0.5}), std::invalid_argument);
  EXPECT_EQ(tree.size(), 1u);
}

TEST(BadInput, anInnerNodeNeedsChildren) {
  VectorTree tree(1);
  tree.addInner(VectorTree::kNoParent);
  try {
    findOptimalTree(tree, kWeights);
    FAIL();
  } catch (const std::logic_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("inner node 0 has no children"), std::string::npos) << message;
  }
}
