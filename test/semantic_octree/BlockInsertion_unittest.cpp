// What scans do to blocks of 4 x 4 x 4 voxels, against voxels that are on their own.
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include "BlockScans.h"
#include "FollowedTree.h"

using namespace semantic_octree;

namespace {

bool isSameLeaf(const SemanticOcTree& tree, const SemanticOcTreeNode& a,
                const SemanticOcTreeNode& b) {
  return b && b.isLeaf() && a.getLogOdds() == b.getLogOdds() &&
         a.hasClassRecord() == b.hasClassRecord() && tree.belief(a) == tree.belief(b);
}

/** Checks all inner nodes below one. \return number of nodes */
std::size_t expectSoundBelow(const SemanticOcTree& tree, const SemanticOcTreeNode& node) {
  if (node.isLeaf()) return 1;
  std::size_t nodes = 1;
  int same = 0;
  float highest = -HUGE_VALF;
  for (int i = 0; i < 8; ++i) {
    const auto child = node.child(i);
    if (!child) continue;
    nodes += expectSoundBelow(tree, child);
    highest = std::max(highest, child.getLogOdds());
    same += node.child(0) && node.child(0).isLeaf() && isSameLeaf(tree, node.child(0), child);
  }
  EXPECT_EQ(node.getLogOdds(), highest);
  EXPECT_FALSE(node.hasClassRecord());
  if (tree.pruning()) {
    EXPECT_LT(same, 8) << "children that agree";
  }
  return nodes;
}

void expectSound(const SemanticOcTree& tree) {
  EXPECT_EQ(expectSoundBelow(tree, tree.root()), tree.size());
  std::size_t leaves = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) ++leaves;
  EXPECT_EQ(leaves, tree.getNumLeafNodes());
}

AbstractionOptions someTerms() {
  AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("1", 1, {1})}, 0.001};
  return options;
}

/** Maps of each kind receive equal scans. */
class Maps {
 public:
  Maps(int classes, const FilterParameters& p)
      : pruned(1.0, numberedClasses(classes), p), plain(1.0, classes, p) {
    unpruned.setPruning(false);
    setAbstraction(abstracted, someTerms());
  }
  void insert(const PosedCloud& scan) {
    InsertionOptions threads;
    threads.threads = 3;
    for (SemanticOcTree* tree : {&pruned, &unpruned, &abstracted})
      tree->insert(scan.cloud, scan.T_map_sensor);
    shared.insert(scan.cloud, scan.T_map_sensor, threads);
    plain.insert(scan, {});
    m_compressed.follow();
  }
  void compare() const {
    expectSame(pruned, plain);
    expectSame(unpruned, plain);
    expectSound(pruned);
    expectSound(unpruned);
    EXPECT_TRUE(shared == pruned) << "by several threads";
    EXPECT_EQ(shared.size(), pruned.size());
    SemanticOcTree anew = pruned;
    setAbstraction(anew, someTerms());
    EXPECT_TRUE(abstracted == anew) << "bookkeeping that is kept up to date";
  }

  SemanticOcTree pruned, unpruned = pruned, shared = pruned, abstracted = pruned;
  PlainMap plain;

 private:
  FollowedTree m_compressed{abstracted};
};

void expectPlainResult(unsigned seed, int classes, const FilterParameters& parameters,
                       int numScans) {
  Maps maps(classes, parameters);
  BlockScans scans(seed, classes);
  for (int i = 0; i < numScans; ++i) {
    maps.insert(scans.next());
    maps.compare();
    if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ", scan " << i;
  }
}

}  // namespace

TEST(BlockInsertion, givesThePlainMapWhateverHappensToABlock) {
  for (unsigned seed = 1; seed <= 4; ++seed) expectPlainResult(seed, 3, {}, 40);
}

TEST(BlockInsertion, givesThePlainMapWithParametersAtTheirBounds) {
  FilterParameters p;
  p.hitProbability = p.maxProbability = 1 - 1e-9;
  p.falseAlarmProbability = p.minOccupancy = 1e-9;
  for (const int classes : {1, 24, 254}) expectPlainResult(20 + classes, classes, p, 15);
}
