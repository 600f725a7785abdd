#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>

#include "BlockScans.h"
#include "FollowedTree.h"
#include "PlainMap.h"
#include "RandomScans.h"
#include "TemporaryFolder.h"

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
  Maps(double resolution, int classes, const FilterParameters& p = {})
      : pruned(resolution, numberedClasses(classes), p), plain(resolution, classes, p) {
    unpruned.setPruning(false);
    for (SemanticOcTree* tree : {&shared, &abstracted}) setAbstraction(*tree, someTerms());
  }
  void insert(const PosedCloud& scan, InsertionOptions options = {}) {
    const PlainScan expected = plainScan(scan, plain.resolution(), options);
    for (SemanticOcTree* tree : {&pruned, &unpruned, &abstracted}) {
      const InsertionReport report = tree->insert(scan.cloud, scan.T_map_sensor, options);
      EXPECT_EQ(report.hitVoxels, expected.hits.size());
      EXPECT_EQ(report.freeVoxels, expected.free.size());
    }
    plain.insert(scan, options);
    options.threads = 3;
    shared.insert(scan.cloud, scan.T_map_sensor, options);
    m_compressed.follow();
  }
  void compare() const {
    expectSame(pruned, plain);
    expectSame(unpruned, plain);
    expectSound(pruned);
    expectSound(unpruned);
    EXPECT_TRUE(shared == abstracted) << "by several threads";
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
  Maps maps(1.0, classes, parameters);
  BlockScans scans(seed, classes);
  for (int i = 0; i < numScans; ++i) {
    maps.insert(scans.next());
    maps.compare();
    if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ", scan " << i;
  }
}

TEST(BlockInsertion, givesThePlainMapWhateverHappensToABlock) {
  for (unsigned seed = 1; seed <= 4; ++seed) expectPlainResult(seed, 3, {}, 40);
}

TEST(BlockInsertion, givesThePlainMapWithParametersAtTheirBounds) {
  FilterParameters p;
  p.hitProbability = p.maxProbability = 1 - 1e-9;
  p.falseAlarmProbability = p.minOccupancy = 1e-9;
  for (const int classes : {1, 24, 254}) expectPlainResult(20 + classes, classes, p, 15);
}

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
    Maps maps(kInsertedResolution, c.classes);
    for (const PosedCloud& scan : severalScans(seed, scans)) maps.insert(scan, options);
    maps.compare();
    EXPECT_LT(maps.pruned.size(), maps.unpruned.size());
  }
}

/** Expects that an insertion is refused, saying so, and that the map is what it was. */
void expectRefused(const std::string& words, const LabeledCloud& cloud,
                   const Eigen::Isometry3d& T_map_sensor = Eigen::Isometry3d::Identity(),
                   const InsertionOptions& options = {}) {
  SemanticOcTree tree(0.1, numberedClasses(3));
  LabeledCloud good;
  good.points = {{1.f, 2.f, 0.3f}};
  good.classes = {2};
  tree.insert(good, Eigen::Isometry3d::Identity());
  SemanticOcTree before = tree;
  const std::string error = errorOf([&] { tree.insert(cloud, T_map_sensor, options); });
  EXPECT_TRUE(contains(error, words));
  EXPECT_TRUE(tree == before);
  // Nothing of the refused scan may come up with the next one.
  tree.insert(good, Eigen::Isometry3d::Identity());
  before.insert(good, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(tree == before);
}

LabeledCloud threePoints() {
  LabeledCloud cloud;
  cloud.points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return cloud;
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(BadInput, sensorOutsideTheMapIsRefused) {
  expectRefused("sensor at (4000, 0, 0) m", threePoints(), at(4000, 0, 0));
  expectRefused("outside the map", threePoints(), at(0, -3277, 0));
  expectRefused("outside the map", threePoints(), at(0, 0, 3276.8));
  expectRefused("(500000, 4000000, 100) m is outside the map, which reaches", threePoints(),
                at(500000, 4e6, 100));
  expectRefused("not finite", threePoints(), at(0, 0, NAN));
  Eigen::Isometry3d twisted = at(0, 0, 0);
  twisted.linear()(0, 0) = INFINITY;
  expectRefused("the sensor's pose has numbers that are not finite", threePoints(), twisted);
}

TEST(BadInput, labelsThatCannotBeAreRefused) {
  LabeledCloud cloud = threePoints();
  cloud.classes = {1, 2};
  expectRefused("2 classes, expected 3", cloud);
  cloud.classes = {1, 3, 4};
  expectRefused("class 4", cloud);
  cloud.classes.clear();
  cloud.probabilities.assign(8, 0.1f);
  expectRefused("8 probabilities, expected 9", cloud);
  cloud.probabilities.push_back(0.1f);
  for (const float bad : {-0.1f, 1.5f, NAN}) {
    cloud.probabilities[7] = bad;
    expectRefused("probability", cloud);
  }
}

TEST(BadInput, scansThatNeedMoreMemoryThanThereIsOrThanAllowedAreRefused) {
  LabeledCloud cloud;
  cloud.points = {{3276, 3276, 3276}, {-3276, -3276, -3276}};
  expectRefused("too large", cloud);
  cloud.points = {{60, 60, 20}, {-60, -60, 0}};
  InsertionOptions options;
  options.maxScanMemory = 1;
  expectRefused("set max_range", cloud, at(0, 0, 0), options);
}

TEST(BadInput, insertionOptionsAreRefusedByName) {
  using O = InsertionOptions;
  const std::pair<void (*)(O&), const char*> faults[] = {
      {[](O& o) { o.maxRange = -1; }, "max_range is -1"},
      {[](O& o) { o.minRange = 5, o.maxRange = 4; }, "less than max_range"},
      {[](O& o) { o.carvingMargin = HUGE_VAL; }, "carving_margin"}};
  EXPECT_EQ(errorOf([] { O().validate(); }), "");
  for (const auto& [change, words] : faults) {
    O options;
    change(options);
    expectRefused(words, threePoints(), at(0, 0, 0), options);
  }
}

TEST(BadInput, treesThatCannotBeAreRefused) {
  for (const double resolution : {0.0, -0.1, static_cast<double>(NAN), HUGE_VAL})
    EXPECT_TRUE(
        contains(errorOf([&] { SemanticOcTree(resolution, numberedClasses(2)); }), "resolution"))
        << resolution;
  EXPECT_TRUE(
      contains(errorOf([] { SemanticOcTree(0.1, ClassTable()); }), "number of classes is 0"));
}

}  // namespace

// What single scans do that can be told by hand.

TEST(SingleScans, ofBeamsAlongVoxelBordersStaysInTheBeamsNeighborhood) {
  std::mt19937 random(8);
  for (int i = 0; i < 300; ++i) {
    SemanticOcTree tree(1.0, numberedClasses(1));
    LabeledCloud cloud;
    const auto whole = [&] { return static_cast<float>(static_cast<int>(random() % 13) - 6); };
    cloud.points = {{whole(), whole(), whole()}};
    Eigen::Isometry3d T_map_sensor(Eigen::Translation3d(whole(), whole(), whole()));
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

TEST(SingleScans, reportsWhatBecameOfEachPoint) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  LabeledCloud cloud;
  cloud.points = {{NAN, 0, 0}, {0, INFINITY, 0}, {0.1f, 0, 0},
                  {1, 0, 0},   {50, 0, 0},       {1e30f, 0, 0}};
  InsertionOptions options;
  options.maxRange = 10;
  options.minRange = 0.5;
  const InsertionReport report = tree.insert(cloud, Eigen::Isometry3d::Identity(), options);
  EXPECT_EQ(report.points, 6u);
  EXPECT_EQ(report.skippedNotFinite, 2u);
  EXPECT_EQ(report.skippedNear, 1u);
  EXPECT_EQ(report.beyondRange, 2u);
  EXPECT_EQ(report.hitVoxels, 1u);
  EXPECT_EQ(report.freeVoxels, 99u);
}

TEST(SingleScans, skipsReturnsOutsideTheMap) {
  SemanticOcTree tree(0.001, numberedClasses(2));  // reaches 32.768 m
  LabeledCloud cloud;
  cloud.points = {{40, 0, 0}, {0, -40, 0}, {32.7f, 0, 0}};
  EXPECT_EQ(tree.insert(cloud, Eigen::Isometry3d::Identity()).skippedOutside, 2u);
  EXPECT_EQ(tree.query(32.7, 0, 0).status, CellState::Status::Occupied);
}

TEST(SingleScans, worksInTheOutermostVoxels) {
  for (const double corner : {-double{kKeyOfOrigin}, kKeyOfOrigin - 0.5}) {
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

TEST(SingleScans, ofAnEmptyCloudChangesNothing) {
  SemanticOcTree tree(0.1, numberedClasses(2));
  EXPECT_EQ(tree.insert({}, Eigen::Isometry3d::Identity()).points, 0u);
  EXPECT_TRUE(tree.empty());
  LabeledCloud onlyNan;
  onlyNan.points = {{NAN, NAN, NAN}};
  tree.insert(onlyNan, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(tree.empty());
}
