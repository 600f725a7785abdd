#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include "PlainMap.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

SemanticOcTree treeOfScans(unsigned seed, double resolution = 0.3, int classes = 5) {
  std::mt19937 random(seed);
  SemanticOcTree tree(resolution, numberedClasses(classes));
  for (int i = 0; i < 3; ++i) {
    const PosedCloud scan = randomScan(random);
    tree.insert(scan.cloud, scan.T_map_sensor);
  }
  return tree;
}

void insertOne(SemanticOcTree& tree, unsigned seed, const InsertionOptions& options = {}) {
  std::mt19937 random(seed);
  const PosedCloud scan = randomScan(random);
  tree.insert(scan.cloud, scan.T_map_sensor, options);
}

}  // namespace

TEST(Tree, copiesShareNothing) {
  SemanticOcTree original = treeOfScans(1);
  const SemanticOcTree copy = original, second = original;
  EXPECT_TRUE(copy == original);
  insertOne(original, 2);
  EXPECT_FALSE(copy == original);
  EXPECT_TRUE(copy == second);
  original.clear();
  EXPECT_TRUE(copy == second);
}

TEST(Tree, keepsItsNodesWhereBookkeepingComesAndGoes) {
  SemanticOcTree plain = treeOfScans(18), tree = plain;
  AbstractionOptions options;
  for (unsigned seed = 20; seed < 24; ++seed) {
    options.weights.terms.push_back(tree_abstraction::relevant(std::to_string(seed), 1, {1}));
    setAbstraction(tree, options);
    EXPECT_TRUE(tree == plain);
    SemanticOcTree copy = tree;
    for (SemanticOcTree* map : {&plain, &tree, &copy}) insertOne(*map, seed);
    EXPECT_TRUE(copy == tree);
    EXPECT_TRUE(tree == plain);
    if (seed % 2) dropAbstraction(tree);
    insertOne(copy, seed + 10);
    EXPECT_FALSE(copy == tree);
    EXPECT_TRUE(tree == plain);
    EXPECT_EQ(tree.size(), plain.size());
  }
}

TEST(Tree, assignmentReplacesEverything) {
  const SemanticOcTree a = treeOfScans(4, 0.3);
  SemanticOcTree b = treeOfScans(5, 0.5, 9);
  b = a;
  EXPECT_TRUE(a == b);
  EXPECT_EQ(b.getResolution(), 0.3);
  EXPECT_EQ(b.numClasses(), 5);
  const SemanticOcTree& self = b;
  b = self;
  EXPECT_TRUE(a == b);
}

TEST(Tree, movingLeavesAnEmptyMapOfTheSameKindBehind) {
  SemanticOcTree original = treeOfScans(6);
  const SemanticOcTree copy = original;
  const SemanticOcTree moved = std::move(original);
  EXPECT_TRUE(moved == copy);
  EXPECT_TRUE(original.empty());
  EXPECT_EQ(original.getResolution(), 0.3);
  insertOne(original, 7);
  SemanticOcTree fresh(0.3, numberedClasses(5));
  insertOne(fresh, 7);
  EXPECT_TRUE(original == fresh);
}

TEST(Tree, swappingExchangesEverything) {
  SemanticOcTree a = treeOfScans(8, 0.3), b = treeOfScans(9, 0.5, 9);
  const SemanticOcTree copyOfA = a, copyOfB = b;
  a.swap(b);
  EXPECT_TRUE(a == copyOfB);
  EXPECT_TRUE(b == copyOfA);
  EXPECT_EQ(a.coordToKey(10, 0, 0)[0], octomap::key_type(kKeyOfOrigin + 20));
  insertOne(a, 10);
  SemanticOcTree expected = copyOfB;
  insertOne(expected, 10);
  EXPECT_TRUE(a == expected);
}

TEST(Tree, differsFromAnotherInEachPart) {
  const SemanticOcTree tree = treeOfScans(13);
  EXPECT_FALSE(tree == treeOfScans(14));
  EXPECT_FALSE(tree == treeOfScans(13, 0.31));
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) == SemanticOcTree(0.1, numberedClasses(6)));
  FilterParameters other;
  other.accuracy = 0.8;
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) ==
               SemanticOcTree(0.1, numberedClasses(5), other));
  SemanticOcTree unpruned(0.1, numberedClasses(5));
  unpruned.setPruning(false);
  EXPECT_FALSE(SemanticOcTree(0.1, numberedClasses(5)) == unpruned);
}

TEST(Tree, pruningIsChosenWhileTheTreeIsEmpty) {
  SemanticOcTree tree = treeOfScans(16);
  EXPECT_TRUE(tree.pruning());
  EXPECT_THROW(tree.setPruning(false), std::logic_error);
  tree.clear();
  tree.setPruning(false);
  EXPECT_FALSE(tree.pruning());
  insertOne(tree, 17);
  EXPECT_FALSE(SemanticOcTree(tree).pruning());
}
