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

/** Inserts into trees with and without pruning, by one thread and by three, and into the plain map.
 */
void expectPlainResult(const std::vector<PosedCloud>& scans, const InsertionOptions& options,
                       int classes) {
  SemanticOcTree pruned(kInsertedResolution, numberedClasses(classes)), unpruned = pruned,
                                                                        threaded = pruned;
  unpruned.setPruning(false);
  PlainMap plain(kInsertedResolution, classes);
  InsertionOptions threads = options;
  threads.threads = 3;
  for (const PosedCloud& scan : scans) {
    const PlainScan expected = plainScan(scan, kInsertedResolution, options);
    for (SemanticOcTree* tree : {&pruned, &unpruned}) {
      const InsertionReport report = tree->insert(scan.cloud, scan.T_map_sensor, options);
      EXPECT_EQ(report.hitVoxels, expected.hits.size());
      EXPECT_EQ(report.freeVoxels, expected.free.size());
    }
    threaded.insert(scan.cloud, scan.T_map_sensor, threads);
    plain.insert(scan, options);
  }
  expectSame(pruned, plain);
  expectSame(unpruned, plain);
  EXPECT_TRUE(threaded == pruned);
  EXPECT_LT(pruned.size(), unpruned.size());
}

}  // namespace

TEST(Insertion, ofAnyScansGivesThePlainMapToTheLastBit) {
  struct Case {
    double maxRange = 0, minRange = 0, carvingMargin = 0;
    InsertionOptions::Rays rays = InsertionOptions::Rays::All;
    int classes = 5;
    bool softLabels = false;
  };
  constexpr auto kAll = InsertionOptions::Rays::All, kEnds = InsertionOptions::Rays::EndVoxels;
  const Case cases[] = {{},
                        {4},
                        {5, 2},
                        {5, 0, 0, kEnds},
                        {5, 0, 0.5},
                        {5, 0, 0.5, kEnds},
                        {5, 0, 0, kAll, 5, true},
                        {5, 0, 0, kEnds, 5, true},
                        {5, 0, 0, kAll, 1},
                        {5, 0, 0, kAll, 2},
                        {5, 0, 0, kAll, 254}};
  unsigned seed = 0;
  for (const Case& c : cases) {
    SCOPED_TRACE(++seed);
    InsertionOptions options;
    options.maxRange = c.maxRange, options.minRange = c.minRange;
    options.carvingMargin = c.carvingMargin, options.rays = c.rays;
    RandomScanOptions scans;
    scans.classes = c.classes, scans.softLabels = c.softLabels;
    expectPlainResult(severalScans(seed, scans), options, c.classes);
  }
}
