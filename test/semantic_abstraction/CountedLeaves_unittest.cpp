#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <cmath>

#include "AllAlphas.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr int kLeafClasses = 3;
constexpr double kLeafResolution = 0.2;

AbstractionOptions optionsWith(double blockSize) {
  AbstractionOptions o;
  o.weights.terms = {tree_abstraction::relevant("posts", 1.0, {1}),
                     tree_abstraction::irrelevant("ground", 0.3, {2, 3})};
  o.blockSize = blockSize;
  return o;
}

/** A ball of free space seen so often that it merges to large leaves, with returns here and there.
 */
SemanticOcTree mapWithLargeLeaves(unsigned seed, bool pruning) {
  std::mt19937 random(seed);
  PosedCloud scan;
  scan.T_map_sensor = randomPose(random, 2);
  for (int i = 0; i < 12000; ++i) {
    Eigen::Vector3d direction;
    for (int axis = 0; axis < 3; ++axis) direction[axis] = between(random, -1, 1);
    const bool isReturn = random() % 20 == 0;
    scan.cloud.points.push_back(
        (direction.normalized() * (isReturn ? between(random, 2, 4) : 50)).cast<float>());
    scan.cloud.classes.push_back(
        static_cast<semantic_types::ClassId>(random() % (kLeafClasses + 1)));
  }
  InsertionOptions options;
  options.maxRange = 4;
  SemanticOcTree map(kLeafResolution, numberedClasses(kLeafClasses));
  map.setPruning(pruning);
  for (int i = 0; i < 5; ++i) map.insert(scan.cloud, scan.T_map_sensor, options);
  return map;
}

/** Leaves of a map by its iterator, and the same with each leaf above `blockDepth` counted as the
 * blocks that it stands for. */
struct Counts {
  std::size_t leaves = 0, inBlocks = 0;
  unsigned shallowest = 16;
};
Counts countLeaves(const SemanticOcTree& map, unsigned blockDepth) {
  Counts c;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    ++c.leaves;
    const unsigned depth = leaf.getDepth();
    c.inBlocks += depth < blockDepth ? std::size_t(1) << 3 * (blockDepth - depth) : 1;
    c.shallowest = std::min(c.shallowest, depth);
  }
  return c;
}

unsigned depthOfBlocks(double blockSize) {
  return 16 - std::lround(std::log2(blockSize / kLeafResolution));
}

/** About `most` of a path's trees, first and last among them. */
std::vector<std::size_t> someTrees(std::size_t numTrees, std::size_t most) {
  std::vector<std::size_t> trees;
  for (std::size_t i = 0; i <= most; ++i) trees.push_back((numTrees - 1) * i / most);
  return trees;
}

}  // namespace

TEST(CountedLeaves, ofEachTreeOnThePathAreTheCompressedTreesForEveryBlockSize) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    for (const bool pruning : {true, false}) {
      SemanticOcTree map = mapWithLargeLeaves(seed, pruning);
      const unsigned shallowest = countLeaves(map, 0).shallowest;
      if (pruning) {
        ASSERT_LE(shallowest, 13u) << "there are leaves larger than some blocks";
      }
      for (const double blockSize : {0.2, 0.4, 0.8, 1.6, 3.2, 12.8}) {
        setAbstraction(map, optionsWith(blockSize));
        Abstraction abstraction(map);
        const AllAlphas path(abstraction);
        EXPECT_EQ(abstraction.measures().full.numKnownLeaves, map.getNumLeafNodes());
        for (const std::size_t k : someTrees(path.trees.numTrees(), 10)) {
          abstraction.setAlpha(path.trees.alpha(k));
          const Counts counts = countLeaves(abstraction.compressedMap(), depthOfBlocks(blockSize));
          ASSERT_EQ(path.leaves[k], counts.leaves) << "block " << blockSize << ", tree " << k;
          ASSERT_EQ(abstraction.measures().compressed.numKnownLeaves, counts.leaves);
          ASSERT_EQ(abstraction.leaves().size(), counts.inBlocks);
        }
        dropAbstraction(map);
      }
    }
  }
}
