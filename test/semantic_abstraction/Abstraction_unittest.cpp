#include <gtest/gtest.h>
#include <semantic_abstraction/AlphaTrees.h>

#include <algorithm>
#include <set>

#include "FollowedTree.h"
#include "OctreeAsTree.h"
#include "SmallScans.h"
#include "ThreeTerms.h"

namespace {

using namespace semantic_octree;

constexpr int kTreeClasses = 6;
constexpr double kTreeResolution = 0.2;

AbstractionOptions someOptions(double alpha) { return threeTerms(alpha, kTreeClasses, 0.05); }

InsertionOptions someInsertion(int threads = 1) {
  InsertionOptions o;
  o.maxRange = 9;
  o.threads = threads;
  return o;
}

SemanticOcTree mapOf(const std::vector<PosedCloud>& scans,
                     const AbstractionOptions* options = nullptr, bool pruning = true,
                     int threads = 1) {
  SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
  map.setPruning(pruning);
  if (options) setAbstraction(map, *options);
  for (const PosedCloud& s : scans) map.insert(s.cloud, s.T_map_sensor, someInsertion(threads));
  return map;
}

TEST(Abstraction, incrementalUpkeepEqualsBatchToTheLastBitAfterEveryScan) {
  const auto options = someOptions(0.01);
  for (const bool pruning : {true, false}) {
    std::vector<PosedCloud> scans = scansOfSmallPlace(5, 3000, kTreeClasses, 7);
    for (int order = 0; order < 2; ++order) {
      SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
      map.setPruning(pruning);
      setAbstraction(map, options);
      for (const PosedCloud& s : scans) {
        map.insert(s.cloud, s.T_map_sensor, someInsertion());
        SemanticOcTree batch(map);
        dropAbstraction(batch);
        setAbstraction(batch, options);
        ASSERT_TRUE(map == batch);
      }
      std::reverse(scans.begin(), scans.end());
    }
  }
}

TEST(Abstraction, threadsLeaveNoTrace) {
  const auto options = someOptions(0.01);
  const auto scans = scansOfSmallPlace(4, 4000, kTreeClasses, 3);
  EXPECT_TRUE(mapOf(scans, &options, true, 1) == mapOf(scans, &options, true, 3));
}

TEST(Abstraction, agreesWithThePlainSearchOnTheSameTree) {
  for (const double alpha : {0.0, 0.001, 0.01, 0.03, 0.1}) {
    for (const auto frame : {AbstractionOptions::Frame::Free, AbstractionOptions::Frame::Charged}) {
      AbstractionOptions options = someOptions(alpha);
      options.frame = frame;
      SemanticOcTree map = mapOf(scansOfSmallPlace(3, 2000, kTreeClasses, 11), &options);
      const int blockDepth = 12;  // 3.2 m = 16 voxels
      const bool free = frame == AbstractionOptions::Frame::Free;
      const OctreeAsTree plain(map, free ? blockDepth : 0, blockDepth);
      const auto oracle = reference::findOptimalTree(plain.forest, options.weights);

      const Abstraction abstraction(map);
      const AbstractionMeasures measures = abstraction.measures();
      EXPECT_NEAR(abstraction.objective(), oracle.objective,
                  1e-9 * std::max(1.0, oracle.objective));
      const std::set<LeafId> expected = plain.knownAmong(oracle.leaves());
      std::size_t unknownInBlocks = 0;
      for (const auto leaf : oracle.leaves())
        unknownInBlocks += !plain.places[leaf].node && plain.places[leaf].depth > blockDepth;
      EXPECT_EQ(idsOf(abstraction.leaves()), expected) << "alpha " << alpha;
      EXPECT_EQ(measures.compressed.numKnownLeaves, expected.size());
      EXPECT_EQ(measures.full.numKnownLeaves, map.getNumLeafNodes());
      if (free) continue;  // the oracle's measures start at the roots
      EXPECT_NEAR(measures.full.leafEntropy, oracle.full.leafEntropy, 1e-9);
      EXPECT_EQ(measures.compressed.numLeaves, expected.size() + unknownInBlocks);
      for (std::size_t t = 0; t < options.weights.terms.size(); ++t) {
        EXPECT_NEAR(measures.full.information[t], oracle.full.information[t], 1e-10);
        EXPECT_NEAR(measures.compressed.information[t], oracle.optimal.information[t], 1e-10);
      }
    }
  }
}

TEST(Abstraction, prunedMapHasTheCompressedTreeOfTheUnprunedOne) {
  const auto options = someOptions(0.01);
  const auto scans = scansOfSmallPlace(5, 3000, kTreeClasses, 5);
  SemanticOcTree pruned = mapOf(scans, &options), unpruned = mapOf(scans, &options, false);
  ASSERT_LT(pruned.size(), unpruned.size());
  EXPECT_EQ(idsOf(Abstraction(pruned).leaves()), idsOf(Abstraction(unpruned).leaves()));
  EXPECT_EQ(Abstraction(pruned).objective(), Abstraction(unpruned).objective());
  const auto a = Abstraction(pruned).measures().full, b = Abstraction(unpruned).measures().full;
  for (std::size_t t = 0; t < a.information.size(); ++t)
    EXPECT_NEAR(a.information[t], b.information[t], 1e-12);
}

TEST(Abstraction, changesAddUpToTheLeaves) {
  SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
  setAbstraction(map, someOptions(0.01));
  Abstraction abstraction(map);
  FollowedTree kept(map);
  for (const PosedCloud& s : scansOfSmallPlace(6, 3000, kTreeClasses, 9)) {
    map.insert(s.cloud, s.T_map_sensor, someInsertion());
    kept.follow();
  }
  ASSERT_GT(kept.size(), 10u);
  abstraction.setAlpha(0.03);
  kept.follow();
  abstraction.setWeights({0.1, -1.0, 0.2}, 0.001);
  kept.follow();
  map.clear();
  kept.follow();
  EXPECT_EQ(kept.size(), 0u);
}

TEST(Abstraction, newWeightsEqualStartingWithThem) {
  const auto scans = scansOfSmallPlace(3, 3000, kTreeClasses, 4);
  AbstractionOptions options = someOptions(0.01);
  SemanticOcTree map = mapOf(scans, &options);
  Abstraction(map).setWeights({0.2, -0.7, 0.3}, 0.002);
  const double weights[] = {0.2, -0.7, 0.3};
  for (int t = 0; t < 3; ++t) options.weights.terms[t].weight = weights[t];
  options.weights.alpha = 0.002;
  EXPECT_TRUE(map == mapOf(scans, &options));
}

TEST(Abstraction, movedRegionsEqualStartingWithThem) {
  const auto scans = scansOfSmallPlace(3, 3000, kTreeClasses, 4);
  AbstractionOptions options = someOptions(0.01);
  const auto region = [](Region::Shape shape, double x, double weight) {
    return Region{shape, {x, -2, -1}, {x + 2, 3, 2}, 1.5, weight};
  };
  options.regions = {region(Region::Shape::Box, 0, 5), region(Region::Shape::Sphere, -3, 0)};
  SemanticOcTree map = mapOf(scans, &options);
  options.regions = {region(Region::Shape::Box, 1, 5), region(Region::Shape::Corridor, -2, 3)};
  Abstraction(map).setRegions(options.regions);
  EXPECT_TRUE(map == mapOf(scans, &options));
  EXPECT_FALSE(Abstraction(map).leaves().empty());
}

TEST(Abstraction, regionsWithWeightZeroVanish) {
  const auto scans = scansOfSmallPlace(3, 3000, kTreeClasses, 4);
  AbstractionOptions options = someOptions(1e-6);
  options.regions = {{Region::Shape::Box, {-100, -100, -100}, {0, 100, 100}, 0, 0.0}};
  SemanticOcTree map = mapOf(scans, &options);
  std::size_t fine = 0;
  for (const LeafCell& l : Abstraction(map).leaves()) {
    const auto center = map.keyToCoord(l.key(), l.depth);
    fine += center.x() > 0 && l.depth == 16;
    if (center.x() < -1.6) {
      EXPECT_EQ(l.depth, 12);
    }
  }
  EXPECT_GT(fine, 100u);
}

TEST(Abstraction, wholeMapCollapsesToItsRootWithoutBlocksOrFreeFrame) {
  // 16 levels are mostly unknown space: what is known is too small a part of it to pay.
  const auto scans = scansOfSmallPlace(3, 3000, kTreeClasses, 4);
  AbstractionOptions options = someOptions(1e-4);
  EXPECT_GT(Abstraction(*std::make_unique<SemanticOcTree>(mapOf(scans, &options))).leaves().size(),
            1000u);
  options.blockSize = 0;
  options.frame = AbstractionOptions::Frame::Charged;
  SemanticOcTree map = mapOf(scans, &options);
  EXPECT_EQ(Abstraction(map).leaves().size(), 1u);
}

TEST(Abstraction, pathOverAlphaLeadsToAWantedNumberOfLeaves) {
  const AbstractionOptions options = someOptions(0.01);
  SemanticOcTree map = mapOf(scansOfSmallPlace(4, 4000, kTreeClasses, 6), &options);
  Abstraction abstraction(map);
  const AlphaTrees trees(abstraction);
  const auto least = static_cast<std::size_t>(trees.tree(0).leaves),
             most = static_cast<std::size_t>(trees.tree(trees.numTrees() - 1).leaves);
  std::size_t before = 0;
  for (std::size_t wanted = least; wanted < most; wanted += 1 + most / 17) {
    abstraction.setAlpha(trees.alphaForLeaves(wanted));
    const std::size_t leaves = abstraction.leaves().size();
    EXPECT_LE(leaves, wanted);
    EXPECT_GE(leaves, before);
    before = leaves;
  }
  EXPECT_GT(before, most / 2);
  EXPECT_THROW(trees.alphaForLeaves(10 * map.size()), std::invalid_argument);
  EXPECT_THROW(trees.alphaForLeaves(0), std::invalid_argument);
}

TEST(Abstraction, leavesInABoxAreThoseOfAllThatMeetIt) {
  const AbstractionOptions options = someOptions(0.02);
  SemanticOcTree map = mapOf(scansOfSmallPlace(3, 3000, kTreeClasses, 8), &options);
  const Abstraction abstraction(map);
  const octomap::OcTreeKey low(32760, 32750, 32760), high(32775, 32790, 32770);
  for (const bool onlyOccupied : {false, true}) {
    std::vector<LeafCell> expected;
    for (const LeafCell& l : abstraction.leaves()) {
      const int edge = 1 << (16 - l.depth);
      bool meets = !onlyOccupied || l.node->getLogOdds() > 0;
      for (int i = 0; i < 3; ++i) {
        const int first = l.key()[i] / edge * edge;
        meets = meets && first <= high[i] && first + edge > low[i];
      }
      if (meets) expected.push_back(l);
    }
    EXPECT_GT(expected.size(), 10u);
    EXPECT_EQ(abstraction.leavesIn(low, high, onlyOccupied), expected);
  }
}

TEST(Abstraction, compressedMapHasTheCompressedTreesLeavesAndAnswersQueries) {
  const AbstractionOptions options = someOptions(0.02);
  SemanticOcTree map = mapOf(scansOfSmallPlace(4, 4000, kTreeClasses, 6), &options);
  const Abstraction abstraction(map);
  const SemanticOcTree compressed = abstraction.compressedMap();
  const auto leaves = abstraction.leaves();
  EXPECT_EQ(compressed.getNumLeafNodes(), leaves.size());
  for (const LeafCell& l : leaves) {
    const CellState fine = map.query(l.key(), l.depth), coarse = compressed.query(l.key(), l.depth);
    ASSERT_EQ(fine.status, coarse.status);
    ASSERT_EQ(fine.occupancy, coarse.occupancy);
    ASSERT_EQ(fine.likeliestClass, coarse.likeliestClass);
  }
}

TEST(Abstraction, leavesKnowTheVoxelsThatTheyStandFor) {
  const AbstractionOptions options = someOptions(0.02);
  SemanticOcTree map = mapOf(scansOfSmallPlace(2, 2000, kTreeClasses, 6), &options);
  for (const LeafCell& l : Abstraction(map).leaves()) {
    const octomap::point3d center = map.keyToCoord(l.key(), l.depth);
    ASSERT_NEAR(l.edge() * kTreeResolution, map.getNodeSize(l.depth), 1e-9);
    for (unsigned axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(lowerBorderOf(l.lowest[axis], kTreeResolution) + l.edge() * kTreeResolution / 2,
                  center(axis), 1e-3);
  }
}

TEST(Abstraction, refusesBadOptionsAndNamesThem) {
  SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
  EXPECT_THROW(Abstraction{map}, std::logic_error);
  const auto message = [&](auto change) {
    AbstractionOptions o = someOptions(0.01);
    change(o);
    try {
      setAbstraction(map, o);
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  using O = AbstractionOptions;
  const auto says = [](const std::string& m, const char* what) {
    return m.find(what) != std::string::npos;
  };
  EXPECT_PRED2(says, message([](O& o) { o.weights.alpha = -1; }), "alpha");
  EXPECT_PRED2(says, message([](O& o) { o.weights.terms[0].weight = NAN; }), "weight");
  EXPECT_PRED2(says, message([](O& o) { o.weights.terms[0].groups = {{kTreeClasses + 1}}; }), "7");
  EXPECT_PRED2(says, message([](O& o) { o.weights.terms[1].groups = {{1}}; }), "1");
  EXPECT_PRED2(says, message([](O& o) { o.blockSize = -2; }), "block_size");
  EXPECT_PRED2(says, message([](O& o) {
                 o.regions = {{Region::Shape::Sphere, {}, {}, -1, 1}};
               }),
               "radius");
  EXPECT_FALSE(hasAbstraction(map));
}

}  // namespace
