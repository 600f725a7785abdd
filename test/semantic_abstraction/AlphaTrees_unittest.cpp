#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "AllAlphas.h"
#include "RandomScans.h"
#include "SmallScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;
using Frame = AbstractionOptions::Frame;

namespace {

constexpr int kPathClasses = 6;
constexpr double kPathResolution = 0.2;

AbstractionOptions optionsWith(double blockSize, Frame frame) {
  AbstractionOptions o;
  o.weights.terms = {tree_abstraction::relevant("posts", 1.0, {1}),
                     tree_abstraction::irrelevant("ground", 0.3, {2, 3}),
                     tree_abstraction::wholeClassVariable("everything", 0.05, kPathClasses)};
  o.blockSize = blockSize;
  o.frame = frame;
  return o;
}

SemanticOcTree smallMap(const AbstractionOptions& options) {
  SemanticOcTree map(kPathResolution, numberedClasses(kPathClasses));
  setAbstraction(map, options);
  InsertionOptions insertion;
  insertion.maxRange = 9;
  for (const PosedCloud& s : scansOfSmallPlace(3, 2000, kPathClasses, 5))
    map.insert(s.cloud, s.T_map_sensor, insertion);
  return map;
}

/** Information of the terms of one sign, times the amounts of their weights. */
double ofSign(double sign, const AbstractionOptions& options, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t t = 0; t < values.size(); ++t)
    sum += std::max(0.0, sign * options.weights.terms[t].weight) * values[t];
  return sum;
}

/** A ball of free space seen so often that it merges to large leaves, with returns here and there.
 */
SemanticOcTree mapWithLargeLeaves(const AbstractionOptions& abstraction, bool pruning) {
  std::mt19937 random(1);
  PosedCloud scan;
  scan.T_map_sensor = randomPose(random, 2);
  for (int i = 0; i < 12000; ++i) {
    Eigen::Vector3d direction;
    for (int axis = 0; axis < 3; ++axis) direction[axis] = between(random, -1, 1);
    const bool isReturn = random() % 20 == 0;
    scan.cloud.points.push_back(
        (direction.normalized() * (isReturn ? between(random, 2, 4) : 50)).cast<float>());
    scan.cloud.classes.push_back(
        static_cast<semantic_types::ClassId>(random() % (kPathClasses + 1)));
  }
  InsertionOptions options;
  options.maxRange = 4;
  SemanticOcTree map(kPathResolution, numberedClasses(kPathClasses));
  map.setPruning(pruning);
  for (int i = 0; i < 5; ++i) map.insert(scan.cloud, scan.T_map_sensor, options);
  setAbstraction(map, abstraction);
  return map;
}

/** Leaves of a map by its iterator, and the same with each leaf above `blockDepth` counted as the
 * blocks that it stands for. */
struct Counts {
  std::size_t leaves = 0, inBlocks = 0;
};
Counts countLeaves(const SemanticOcTree& map, unsigned blockDepth) {
  Counts c;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    ++c.leaves;
    const unsigned depth = leaf.getDepth();
    c.inBlocks += depth < blockDepth ? std::size_t(1) << 3 * (blockDepth - depth) : 1;
  }
  return c;
}

unsigned depthOfBlocks(double blockSize) {
  return blockSize > 0 ? 16 - std::lround(std::log2(blockSize / kPathResolution)) : 0;
}

/** Calls f(abstraction) for maps with blocks of several sizes and either frame, some of which have
 * leaves that are larger. */
template <typename F>
void forEachMap(const F& f) {
  for (const double blockSize : {0.0, 0.2, 0.8, 3.2})
    for (const auto frame : {Frame::Free, Frame::Charged}) {
      SCOPED_TRACE("block " + std::to_string(blockSize) + (frame == Frame::Free ? ", free" : ""));
      const AbstractionOptions options = optionsWith(blockSize, frame);
      SemanticOcTree small = smallMap(options);
      SemanticOcTree ofBall = mapWithLargeLeaves(options, blockSize < 3);
      for (SemanticOcTree* map : {&small, &ofBall}) {
        Abstraction abstraction(*map);
        EXPECT_EQ(abstraction.measures().full.numKnownLeaves, map->getNumLeafNodes());
        f(abstraction);
      }
    }
}

TEST(AlphaTrees, haveWhatTheCompressedTreesOfTheirAlphasHave) {
  forEachMap([](Abstraction& abstraction) {
    const AlphaTrees trees(abstraction);
    const AbstractionOptions options = abstraction.options();
    const auto expectSame = [&](const AddedToTree& tree, const auto& measured) {
      EXPECT_EQ(tree.leaves, static_cast<double>(measured.numKnownLeaves));
      EXPECT_NEAR(tree.relevant, ofSign(1, options, measured.information),
                  1e-12 * trees.full().relevant);
      EXPECT_NEAR(tree.irrelevant, ofSign(-1, options, measured.information),
                  1e-12 * trees.full().irrelevant);
    };
    const std::size_t last = trees.numTrees() - 1;
    for (std::size_t k = 0; k <= last; k += 1 + last / 9) {
      if (trees.alpha(k) < 1e-12) continue;  // for the search that is a tie
      abstraction.setAlpha(trees.alpha(k));
      expectSame(trees.tree(k), abstraction.measures().compressed);
      const Counts counts =
          countLeaves(abstraction.compressedMap(), depthOfBlocks(options.blockSize));
      EXPECT_EQ(trees.tree(k).leaves, static_cast<double>(counts.leaves));
      EXPECT_EQ(abstraction.leaves().size(),
                options.frame == Frame::Free ? counts.inBlocks : counts.leaves);
    }
    expectSame(trees.full(), abstraction.measures().full);
  });
}

TEST(AlphaTrees, findTheTreeThatAllTreesAreSearchedFor) {
  forEachMap([](Abstraction& abstraction) {
    const AlphaTrees trees(abstraction);
    const AllAlphas all(abstraction);
    EXPECT_LE(trees.numTrees(), all.trees.numTrees());
    const auto most = static_cast<std::size_t>(trees.full().leaves);
    for (std::size_t wanted = all.numRoots; wanted <= most; wanted += 1 + most / 60) {
      EXPECT_EQ(trees.alphaForLeaves(wanted), all.alphaForLeaves(wanted)) << wanted;
      const auto fits = [&](double alpha) {
        std::size_t k = 0;
        while (k + 1 < all.trees.numTrees() && all.trees.highestAlpha(k + 1) > alpha) ++k;
        return all.leaves[k] <= static_cast<double>(wanted);
      };
      EXPECT_EQ(trees.largestThat(fits), all.alphaForLeaves(wanted)) << wanted;
    }
    const std::string few = errorOf([&] { trees.alphaForLeaves(all.numRoots - 1); });
    EXPECT_TRUE(contains(few, "the map has " + std::to_string(all.numRoots) + " blocks"));
    const std::string many = errorOf([&] { trees.alphaForLeaves(most + 1); });
    EXPECT_TRUE(contains(many, "the map has only " + std::to_string(most)));
  });
}

TEST(AlphaTrees, areOneTreeWhereNothingIsKnownOrCounts) {
  const AbstractionOptions options = optionsWith(0.8, Frame::Free);
  SemanticOcTree empty(0.2, numberedClasses(kPathClasses));
  setAbstraction(empty, options);
  const Abstraction ofNothing(empty);
  EXPECT_EQ(AlphaTrees(ofNothing).numTrees(), 1u);
  SemanticOcTree map = smallMap(options);
  Abstraction abstraction(map);
  const double far = 1e4;
  abstraction.setRegions({{Region::Shape::Box, {-far, -far, -far}, {far, far, far}, 0, 0}});
  const AlphaTrees trees(abstraction);
  EXPECT_EQ(trees.numTrees(), 1u);
  EXPECT_EQ(trees.full().relevant, 0);
  EXPECT_EQ(trees.full().leaves, static_cast<double>(map.getNumLeafNodes()));
}

}  // namespace
