#include <gtest/gtest.h>

#include "PlainMap.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr double kResolution = 0.2;

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
  SemanticOcTree pruned(kResolution, numberedClasses(classes), parameters), unpruned = pruned;
  unpruned.setPruning(false);
  PlainMap plain(kResolution, classes, parameters);
  for (const PosedCloud& scan : scans) {
    const PlainScan expected = plainScan(scan, kResolution, options);
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

TEST(Insertion, withPublishedConstantsGivesThePlainMap) {
  FilterParameters ssmi;
  ssmi.increments = FilterParameters::Increments::Ssmi;
  expectPlainResult(severalScans(71), range(5), 5, ssmi);
}

TEST(Insertion, keepsTheExactDistributionWhereAtMostThreeClassesWereSeen) {
  const InsertionOptions options = range(6);
  SemanticOcTree tree(kResolution, numberedClasses(5));
  PlainMap plain(kResolution, 5);
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
        1e-5);
  }
  EXPECT_GT(compared, 10000u);
}

TEST(Insertion, givesTheSameMapWithAnyNumberOfThreads) {
  for (const auto rays : {InsertionOptions::Rays::All, InsertionOptions::Rays::EndVoxels})
    for (const bool soft : {false, true}) {
      RandomScanOptions scanOptions;
      scanOptions.softLabels = soft;
      std::vector<SemanticOcTree> trees(3, SemanticOcTree(kResolution, numberedClasses(5)));
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

TEST(Insertion, takesTheMajorityOfLabelsAndTheLowestIdOnATie) {
  const auto classAfter = [](std::vector<ClassId> labels) {
    SemanticOcTree tree(1.0, numberedClasses(9));
    LabeledCloud cloud;
    cloud.points.assign(labels.size(), {3.5f, 0.5f, 0.5f});
    cloud.classes = labels;
    tree.insert(cloud, Eigen::Isometry3d::Identity());
    return tree.query(3.5, 0.5, 0.5).likeliestClass;
  };
  EXPECT_EQ(classAfter({4, 7, 7}), 7);
  EXPECT_EQ(classAfter({7, 4}), 4);
  EXPECT_EQ(classAfter({9, 8, 9, 8, 2}), 8);
  EXPECT_EQ(classAfter({0, 0, 0, 6}), 6) << "points without a class do not vote";
  EXPECT_EQ(classAfter({0, 0}), kNoClass);
}

TEST(Insertion, inventsNoClass) {
  // Voxels with points of classes 3 and 200: nothing in between may come out.
  std::mt19937 random(5);
  SemanticOcTree tree(kResolution, numberedClasses(254));
  for (int i = 0; i < 10; ++i) {
    PosedCloud scan = randomScan(random);
    for (ClassId& id : scan.cloud.classes) id = id % 2 ? 3 : 200;
    tree.insert(scan.cloud, scan.T_map_sensor);
  }
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const ClassId id = tree.query(*leaf).likeliestClass;
    ASSERT_TRUE(id == kNoClass || id == 3 || id == 200) << int(id);
  }
}

TEST(Insertion, countsAVoxelOnceForEachScanForever) {
  // A voxel seen again exactly n scans later for every n up to ten, and 300 scans in a row.
  SemanticOcTree tree(kResolution, numberedClasses(2));
  PlainMap plain(kResolution, 2);
  PosedCloud here, elsewhere;
  here.cloud.points = {{1.1f, 0.1f, 0.1f}, {1.12f, 0.1f, 0.1f}, {3.1f, 0.1f, 0.1f}};
  elsewhere.cloud.points = {{-1.1f, 0.1f, 0.1f}};
  const auto insert = [&](const PosedCloud& scan) {
    tree.insert(scan.cloud, scan.T_map_sensor);
    plain.insert(scan, {});
    expectSame(tree, plain);
  };
  for (int pause = 0; pause < 10; ++pause) {
    insert(here);
    for (int i = 0; i < pause; ++i) insert(elsewhere);
  }
  for (int i = 0; i < 300; ++i) insert(i % 3 ? elsewhere : here);
}

TEST(Insertion, doesNotMissAVoxelThatIsHit) {
  SemanticOcTree tree(1.0, numberedClasses(2));
  LabeledCloud cloud;  // the second beam passes through the voxel in which the first one ends
  cloud.points = {{5.5f, 0.5f, 0.5f}, {9.5f, 0.5f, 0.5f}};
  const InsertionReport report = tree.insert(cloud, Eigen::Isometry3d::Identity());
  EXPECT_EQ(report.hitVoxels, 2u);
  EXPECT_EQ(report.freeVoxels, 8u);
  const FilterParameters p;
  EXPECT_NEAR(tree.query(5.5, 0.5, 0.5).occupancy,
              p.hitProbability / (p.hitProbability + p.falseAlarmProbability), 1e-6)
      << "once hit, never missed";
}

TEST(Insertion, carvesExactlyTheVoxelsOfAnAxisParallelBeamOnBothSidesOfZero) {
  for (const float end : {6.5f, -6.5f}) {
    SemanticOcTree tree(1.0, numberedClasses(2));
    LabeledCloud cloud;
    cloud.points = {{end, 0, 0}};
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation() << 0.5, -0.5, -0.5;
    tree.insert(cloud, T_map_sensor);
    for (int x = -8; x < 9; ++x) {
      const auto status = tree.query(x + 0.5, -0.5, -0.5).status;
      const int last = end > 0 ? 7 : -6;
      if (x == last)
        EXPECT_EQ(status, CellState::Status::Occupied) << x;
      else if (x >= std::min(0, last) && x <= std::max(0, last))
        EXPECT_EQ(status, CellState::Status::Free) << x;
      else
        EXPECT_EQ(status, CellState::Status::Unknown) << x;
    }
    EXPECT_EQ(tree.query(0.5, 0.5, -0.5).status, CellState::Status::Unknown);
  }
}

TEST(Insertion, ofBeamsAlongVoxelBordersStaysInTheBeamsNeighborhood) {
  std::mt19937 random(8);
  for (int i = 0; i < 300; ++i) {
    SemanticOcTree tree(1.0, numberedClasses(1));
    LabeledCloud cloud;
    const auto whole = [&] { return static_cast<float>(static_cast<int>(random() % 13) - 6); };
    cloud.points = {{whole(), whole(), whole()}};
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation() << whole(), whole(), whole();
    tree.insert(cloud, T_map_sensor);
    const Eigen::Vector3d begin = T_map_sensor.translation(), beam = cloud.points[0].cast<double>();
    for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
      const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
      const double t = beam.squaredNorm() > 0
                           ? std::clamp((center - begin).dot(beam) / beam.squaredNorm(), 0.0, 1.0)
                           : 0.0;
      ASSERT_LE((center - begin - t * beam).norm(), std::sqrt(3.0) / 2 + 1e-9);
    }
    const Eigen::Vector3d end = begin + beam;
    ASSERT_EQ(tree.query(end.x(), end.y(), end.z()).status, CellState::Status::Occupied);
  }
}

TEST(Insertion, reportsWhatBecameOfEachPoint) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  LabeledCloud cloud;
  cloud.points = {{NAN, 0, 0}, {0, INFINITY, 0}, {0.1f, 0, 0},
                  {1, 0, 0},   {50, 0, 0},       {1e30f, 0, 0}};
  InsertionOptions options = range(10);
  options.minRange = 0.5;
  const InsertionReport report = tree.insert(cloud, Eigen::Isometry3d::Identity(), options);
  EXPECT_EQ(report.points, 6u);
  EXPECT_EQ(report.skippedNotFinite, 2u);
  EXPECT_EQ(report.skippedNear, 1u);
  EXPECT_EQ(report.beyondRange, 2u);
  EXPECT_EQ(report.hitVoxels, 1u);
  EXPECT_EQ(report.freeVoxels, 99u);
}

TEST(Insertion, skipsReturnsOutsideTheMap) {
  SemanticOcTree tree(0.001, numberedClasses(2));  // reaches 32.768 m
  LabeledCloud cloud;
  cloud.points = {{40, 0, 0}, {0, -40, 0}, {32.7f, 0, 0}};
  EXPECT_EQ(tree.insert(cloud, Eigen::Isometry3d::Identity()).skippedOutside, 2u);
  EXPECT_EQ(tree.query(32.7, 0, 0).status, CellState::Status::Occupied);
}

TEST(Insertion, worksInTheOutermostVoxels) {
  for (const double corner : {-32768.0, 32767.5}) {
    SemanticOcTree tree(1.0, numberedClasses(2));
    Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
    T_map_sensor.translation().setConstant(corner);
    LabeledCloud cloud;
    const float inwards = corner < 0 ? 5.f : -5.f;
    cloud.points = {{inwards, 0, 0}, {0, inwards, 0}, {0, 0, inwards}, {-inwards, 0, 0}};
    const InsertionReport report = tree.insert(cloud, T_map_sensor);
    EXPECT_EQ(report.hitVoxels, 3u);
    EXPECT_EQ(report.skippedOutside, 1u);
    EXPECT_EQ(tree.query(corner, corner, corner).status, CellState::Status::Free);
    EXPECT_EQ(tree.query(corner + inwards, corner, corner).status, CellState::Status::Occupied);
  }
}

TEST(Insertion, ofAnEmptyCloudChangesNothing) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  EXPECT_EQ(tree.insert({}, Eigen::Isometry3d::Identity()).points, 0u);
  EXPECT_TRUE(tree.empty());
  LabeledCloud onlyNan;
  onlyNan.points = {{NAN, NAN, NAN}};
  tree.insert(onlyNan, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(tree.empty());
}

TEST(Insertion, takesAMillionPoints) {
  std::mt19937 random(6);
  PosedCloud scan;
  scan.T_map_sensor = randomPose(random, 2);
  for (int i = 0; i < 1000000; ++i) {
    Eigen::Vector3f p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(between(random, -1, 1));
    scan.cloud.points.push_back(p.normalized() * 10.f);
    scan.cloud.classes.push_back(static_cast<ClassId>(1 + random() % 5));
  }
  SemanticOcTree tree(kResolution, numberedClasses(5));
  const InsertionReport report = tree.insert(scan.cloud, scan.T_map_sensor);
  EXPECT_EQ(report.points, 1000000u);
  // A sphere of radius 50 voxels, all of it seen.
  EXPECT_NEAR(static_cast<double>(report.hitVoxels + report.freeVoxels),
              4.0 / 3 * M_PI * 50 * 50 * 50, 30000);
}
