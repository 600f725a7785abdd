#include <gtest/gtest.h>

#include "PlainMap.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr double kInsertedResolution = 0.2;

/** Scans from several places, each several times: values reach their limits and leaves merge. */
std::vector<PosedCloud> severalScans(unsigned seed, const RandomScanOptions& options = {}) {
  std::mt19937 random(seed);
  std::vector<PosedCloud> scans;
  for (int place = 0; place < 3; ++place) {
    const PosedCloud scan = randomScan(random, options);
    for (int repeat = 0; repeat < 4; ++repeat) scans.push_back(scan);
    scans.push_back(randomScan(random, options));
  }
  return scans;
}

/** Inserts into trees with and without pruning and into the plain map, and compares after each. */
void expectPlainResult(const std::vector<PosedCloud>& scans, const InsertionOptions& options,
                       int classes = 5, const FilterParameters& parameters = {}) {
  SemanticOcTree pruned(kInsertedResolution, numberedClasses(classes), parameters),
      unpruned = pruned;
  unpruned.setPruning(false);
  PlainMap plain(kInsertedResolution, classes, parameters);
  for (const PosedCloud& scan : scans) {
    const PlainScan expected = plainScan(scan, kInsertedResolution, options);
    for (SemanticOcTree* tree : {&pruned, &unpruned}) {
      const InsertionReport report = tree->insert(scan.cloud, scan.T_map_sensor, options);
      EXPECT_EQ(report.hitVoxels, expected.hits.size());
      EXPECT_EQ(report.freeVoxels, expected.free.size());
    }
    plain.insert(scan, options);
  }
  expectSame(pruned, plain);
  expectSame(unpruned, plain);
  EXPECT_LT(pruned.size(), unpruned.size());
}

InsertionOptions range(double maxRange) {
  InsertionOptions options;
  options.maxRange = maxRange;
  return options;
}

}  // namespace

TEST(Insertion, ofAnyScansGivesThePlainMapToTheLastBit) {
  for (unsigned seed = 1; seed <= 4; ++seed) expectPlainResult(severalScans(seed), {});
}

TEST(Insertion, clipsBeamsAtTheMaximumRange) {
  for (unsigned seed = 11; seed <= 13; ++seed) expectPlainResult(severalScans(seed), range(4));
}

TEST(Insertion, ignoresReturnsNearerThanTheMinimumRange) {
  InsertionOptions options = range(5);
  options.minRange = 2;
  expectPlainResult(severalScans(21), options);
}

TEST(Insertion, withOneRayPerEndVoxelGivesThePlainMapToo) {
  InsertionOptions options = range(5);
  options.rays = InsertionOptions::Rays::EndVoxels;
  for (unsigned seed = 31; seed <= 33; ++seed) expectPlainResult(severalScans(seed), options);
}

TEST(Insertion, leavesAMarginBeforeReturnsUncarved) {
  InsertionOptions options = range(5);
  options.carvingMargin = 0.5;
  expectPlainResult(severalScans(41), options);
  options.rays = InsertionOptions::Rays::EndVoxels;
  expectPlainResult(severalScans(42), options);
}

TEST(Insertion, ofSoftLabelsGivesThePlainMap) {
  RandomScanOptions soft;
  soft.softLabels = true;
  for (unsigned seed = 51; seed <= 52; ++seed)
    expectPlainResult(severalScans(seed, soft), range(5));
}

TEST(Insertion, ofOneOrManyClassesGivesThePlainMap) {
  for (const int classes : {1, 2, 3, 254}) {
    RandomScanOptions options;
    options.classes = classes;
    expectPlainResult(severalScans(60 + classes, options), range(5), classes);
  }
}

TEST(Insertion, keepsTheExactDistributionWhereAtMostThreeClassesWereSeen) {
  const InsertionOptions options = range(6);
  SemanticOcTree tree(kInsertedResolution, numberedClasses(5));
  PlainMap plain(kInsertedResolution, 5);
  for (const PosedCloud& scan : severalScans(81)) {
    tree.insert(scan.cloud, scan.T_map_sensor, options);
    plain.insert(scan, options);
  }
  std::size_t compared = 0;
  for (const auto& [id, voxel] : plain.voxels()) {
    if (voxel.classesSeen.size() > 3) continue;
    ++compared;
    ASSERT_LT(
        totalVariation(tree.distribution(*tree.search(keyOf(id))), voxel.exact.distribution()),
        1e-9);
  }
  EXPECT_GT(compared, 10000u);
}

TEST(Insertion, givesTheSameMapWithAnyNumberOfThreads) {
  for (const auto rays : {InsertionOptions::Rays::All, InsertionOptions::Rays::EndVoxels})
    for (const bool soft : {false, true}) {
      RandomScanOptions scanOptions;
      scanOptions.softLabels = soft;
      std::vector<SemanticOcTree> trees(3, SemanticOcTree(kInsertedResolution, numberedClasses(5)));
      for (const PosedCloud& scan : severalScans(91, scanOptions))
        for (int threads = 1; threads <= 3; ++threads) {
          InsertionOptions options = range(6);
          options.rays = rays;
          options.threads = threads;
          trees[threads - 1].insert(scan.cloud, scan.T_map_sensor, options);
        }
      EXPECT_TRUE(trees[0] == trees[1]);
      EXPECT_TRUE(trees[0] == trees[2]);
    }
}

TEST(Insertion, mergesVoxelsOfEqualClassRecordsAndPartsThemAgain) {
  SemanticOcTree tree(1.0, numberedClasses(5));
  PlainMap plain(1.0, 5);
  const auto hitEightVoxels = [&](const std::vector<ClassId>& labels) {
    PosedCloud scan;  // as many as there are labels
    scan.T_map_sensor.translation() << 0.3, 0.2, 0.1;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const Eigen::Vector3d center(4.5 + (i & 1), 6.5 + (i >> 1 & 1), 8.5 + (i >> 2));
      scan.cloud.points.push_back((center - scan.T_map_sensor.translation()).cast<float>());
    }
    scan.cloud.classes = labels;
    tree.insert(scan.cloud, scan.T_map_sensor);
    plain.insert(scan, {});
    expectSame(tree, plain);
    std::size_t merged = 0;
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
      merged += leaf->hasClassRecord() && leaf.getDepth() == 15;
    return merged;
  };
  EXPECT_EQ(hitEightVoxels({1, 1, 1, 1, 2, 2, 2, 2}), 0u) << "as occupied, not the same class";
  EXPECT_EQ(hitEightVoxels({2, 2, 2, 2, 1, 1, 1, 1}), 1u) << "the same classes in another order";
  EXPECT_EQ(hitEightVoxels({3, 3, 3, 3, 3, 3, 3, 3}), 1u);
  EXPECT_EQ(hitEightVoxels({4}), 0u);
  EXPECT_EQ(hitEightVoxels({5, 4, 4, 4, 4, 4, 4, 4}), 0u);
}
