#include <gtest/gtest.h>
#include <map_operations/Calibrator.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "FollowedTree.h"
#include "OctreeAsTree.h"
#include "RowLayout.h"
#include "SmallScans.h"
#include "TemporaryFolder.h"
#include "ThreeTerms.h"
#include "Voxels.h"

namespace {

using namespace semantic_octree;

constexpr int kTreeClasses = 6;
constexpr double kTreeResolution = 0.2;

AbstractionOptions someOptions(double alpha) { return threeTerms(alpha, kTreeClasses, 0.05); }

InsertionOptions someInsertion() {
  InsertionOptions o;
  o.maxRange = 9;
  return o;
}

SemanticOcTree mapOf(const std::vector<PosedCloud>& scans,
                     const AbstractionOptions* options = nullptr, bool pruning = true) {
  SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
  map.setPruning(pruning);
  if (options) setAbstraction(map, *options);
  for (const PosedCloud& s : scans) map.insert(s.cloud, s.T_map_sensor, someInsertion());
  return map;
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

TEST(RowKernel, sortsTheValuesOfEachOctant) {
  std::mt19937 random(4);
  for (const int numValues : {2, 5, 100, 65536}) {
    std::uniform_int_distribution<int> value(0, numValues - 1);
    for (int repeat = 0; repeat < 1000; ++repeat) {
      Units values[64], sorted[64];
      for (Units& v : values) v = static_cast<Units>(kUnknown + value(random));
      sortOctants(values, sorted);
      for (int octant = 0; octant < 64; octant += 8)
        std::sort(values + octant, values + octant + 8);
      ASSERT_TRUE(std::equal(values, values + 64, sorted)) << numValues;
    }
  }
}

TEST(RowKernel, patternsInUseAreFoundAgainHoweverManyThereWere) {
  RowTable<OctantPattern> table(8);
  const auto entryOf = [&](int i) {
    const OctantPattern pattern{{0, 0, 0, 0, 0, 0, 0, static_cast<Units>(i)}};
    return table.find(pattern, [&](const OctantPattern&, double*) { return 1.0 * i; });
  };
  for (int i = 0; i < 6000; i += 8) {
    table.release();
    std::set<const double*> rows;
    for (int j = i; j < i + 8; ++j) rows.insert(entryOf(j).row);
    EXPECT_EQ(rows.size(), 8u);
    for (int j = i; j < i + 8; ++j) EXPECT_EQ(entryOf(j).gValue, j);
  }
}

TEST(Abstraction, takesLittleMemoryBesideTheMap) {
  const auto options = someOptions(0.01);
  const auto scans = scansOfSmallPlace(4, 4000, kTreeClasses, 3);
  EXPECT_LT(mapOf(scans, &options).memoryUsage(), 1.4 * mapOf(scans).memoryUsage());
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

TEST(Abstraction, refusesBadOptionsAndNamesThem) {
  SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses));
  EXPECT_THROW(Abstraction{map}, std::logic_error);
  using O = AbstractionOptions;
  const std::pair<void (*)(O&), const char*> faults[] = {
      {[](O& o) { o.weights.alpha = -1; }, "alpha"},
      {[](O& o) { o.weights.terms[0].weight = NAN; }, "weight"},
      {[](O& o) { o.weights.terms[0].groups = {{kTreeClasses + 1}}; }, "7"},
      {[](O& o) { o.weights.terms[1].groups = {{1}}; }, "1"},
      {[](O& o) { o.blockSize = -2; }, "block_size"},
      {[](O& o) {
         o.regions = {{Region::Shape::Sphere, {}, {}, -1, 1}};
       },
       "radius"}};
  for (const auto& [change, word] : faults) {
    O options = someOptions(0.01);
    change(options);
    const std::string error = errorOf([&] { setAbstraction(map, options); });
    EXPECT_TRUE(contains(error, word));
  }
  EXPECT_FALSE(hasAbstraction(map));
}

// Classes of cells that stand for many voxels, free ones among them.

constexpr int kNamedClasses = 3;  // all of them are named: nothing is truncated

SemanticOcTree smallMap() {
  SemanticOcTree map(0.2, numberedClasses(kNamedClasses));
  InsertionOptions insertion;
  insertion.maxRange = 9;
  for (const PosedCloud& s : scansOfSmallPlace(4, 4000, kNamedClasses, 6))
    map.insert(s.cloud, s.T_map_sensor, insertion);
  return map;
}

/** By cell of 2^levels voxels: sum of the distributions of the voxels in which labels were seen. */
std::map<VoxelId, std::vector<double>> labeledSums(const SemanticOcTree& map, unsigned levels) {
  std::map<VoxelId, std::vector<double>> sums;
  for (const auto& [id, p] : voxelsOf(map)) {
    if (map.query(keyOf(id)).likeliestClass == kNoClass) continue;
    const VoxelId cell = {id[0] >> levels, id[1] >> levels, id[2] >> levels};
    auto& sum = sums.emplace(cell, std::vector<double>(kNamedClasses + 1)).first->second;
    for (int k = 1; k <= kNamedClasses; ++k) sum[k] += p[k];
  }
  return sums;
}

/** p(class | occupied) of a node. */
std::vector<double> givenOccupied(const SemanticOcTree& map, const SemanticOcTree::Node& node) {
  std::vector<double> p = map.distribution(node);
  for (int k = 1; k <= kNamedClasses; ++k) p[k] /= 1 - p[0];
  return p;
}

void expectShares(const std::vector<double>& sum, const std::vector<double>& p) {
  const double all = sum[1] + sum[2] + sum[3];
  for (int k = 1; k <= kNamedClasses; ++k)
    EXPECT_NEAR(p[k], sum[k] / all, 5e-4) << "class " << k;  // the grid
}

AbstractionOptions keepingPosts() {
  AbstractionOptions options;
  options.weights = {{tree_abstraction::relevant("posts", 1.0, {1})}, 0.02};
  options.blockSize = 3.2;
  return options;
}

TEST(CompressedClasses, ofACompressedCellAreThoseOfItsVoxelsInWhichLabelsWereSeen) {
  SemanticOcTree map = smallMap();
  setAbstraction(map, keepingPosts());
  const Abstraction abstraction(map);
  const SemanticOcTree compressed = abstraction.compressedMap();
  std::map<unsigned, std::map<VoxelId, std::vector<double>>> sums;
  for (unsigned levels = 0; levels <= 4; ++levels) sums[levels] = labeledSums(map, levels);
  int merged = 0;
  for (const LeafCell& leaf : abstraction.leaves()) {
    const auto levels = static_cast<unsigned>(kTreeDepth - leaf.depth);
    const VoxelId id = voxelAt(leaf.key()[0], leaf.key()[1], leaf.key()[2]);
    const auto sum = sums.at(levels).find({id[0] >> levels, id[1] >> levels, id[2] >> levels});
    const CellState state = compressed.query(leaf.key());
    EXPECT_EQ(state.likeliestClass != kNoClass, sum != sums.at(levels).end());
    if (state.likeliestClass == kNoClass) continue;
    expectShares(sum->second, givenOccupied(compressed, *compressed.search(leaf.key())));
    EXPECT_EQ(state.occupancy, map.query(leaf.key(), leaf.depth).occupancy);
    merged += levels > 0;
  }
  EXPECT_GT(merged, 50);
}

TEST(CompressedClasses, ofACoarsenedVoxelAreThoseOfItsVoxelsInWhichLabelsWereSeen) {
  const SemanticOcTree map = smallMap(), coarse = coarsened(map, 2);
  for (const auto& [cell, sum] : labeledSums(map, 2))
    expectShares(sum, givenOccupied(coarse, *coarse.search(keyOf(cell))));
}

TEST(CompressedClasses, areThoseThatAreBelievedWhateverIsStated) {
  SemanticOcTree map = smallMap();
  setAbstraction(map, keepingPosts());
  SemanticOcTree before = map;
  std::vector<double> factors(static_cast<std::size_t>(map.numClasses()), 0.5);
  factors[1] = 3;
  for (const Calibration& calibration : {Calibration{0.6, 0.2}, Calibration{0.6, 0.2, factors}}) {
    map.setCalibration(calibration);
    SemanticOcTree again = map;
    setAbstraction(again, keepingPosts());
    EXPECT_TRUE(again == before);  // its G-values, too
    const SemanticOcTree compressed = Abstraction(map).compressedMap();
    EXPECT_TRUE(compressed == Abstraction(before).compressedMap());
  }
  EXPECT_TRUE(Abstraction(before).compressedMap().filterParameters().calibration.isIdentity());
}

TEST(CompressedClasses, areStatedAsTheMapDoesWhereNoCellsAreMerged) {
  SemanticOcTree map = smallMap();
  const AbstractionOptions options = threeTerms(0, map.numClasses(), 1);
  setAbstraction(map, options);
  for (const double power : {0.25, 0.5, 1.5}) {
    map.setCalibration({power, 0});
    EXPECT_NEAR(Abstraction(map).compressedMap().filterParameters().calibration.power, power, 0.02);
  }
  std::vector<double> factors(static_cast<std::size_t>(map.numClasses()), 1);
  factors[1] = 0.2;
  map.setCalibration({0.8, 0, factors});
  const Calibration found = Abstraction(map).compressedMap().filterParameters().calibration;
  EXPECT_NEAR(found.power, 0.8, 0.05);
  ASSERT_EQ(found.factors.size(), factors.size());
  EXPECT_NEAR(found.factors[1] / found.factors[0], 0.2, 0.1);
}

/** A floor of one class in whole cells of 8 voxels' edge, and what a scan of it says: some labels
 * are wrong, one by one. */
class FloorOfCells {
 public:
  explicit FloorOfCells(unsigned seed) : m_random(seed) {}
  PosedCloud scan(double wrong) {
    std::uniform_real_distribution<> share(0, 1);
    PosedCloud scan{{}, Eigen::Isometry3d::Identity()};
    scan.T_map_sensor.translation().z() = 3;
    for (int x = -kEdge; x < kEdge; ++x)
      for (int y = -kEdge; y < kEdge; ++y) {
        scan.cloud.points.emplace_back(kTreeResolution * (x + 0.5), kTreeResolution * (y + 0.5),
                                       kTreeResolution / 2 - 3);
        const int truth = classAt(x, y), other = 1 + static_cast<int>(m_random() % 5);
        scan.cloud.classes.push_back(
            static_cast<ClassId>(share(m_random) < wrong ? 1 + (truth - 1 + other) % 6 : truth));
      }
    return scan;
  }
  /** Mean of what is stated of the likeliest class less how often it is right. */
  static double gap(const SemanticOcTree& map) {
    double sum = 0;
    for (int x = -kEdge; x < kEdge; ++x)
      for (int y = -kEdge; y < kEdge; ++y) {
        const CellState state = map.query(keyOf({x, y, 0}));
        sum += state.probability / state.occupancy - (state.likeliestClass == classAt(x, y));
      }
    return sum / (4.0 * kEdge * kEdge);
  }

 private:
  static constexpr int kEdge = 40;
  static int classAt(int x, int y) { return 1 + ((x + kEdge) / 8 + (y + kEdge) / 8 * 2) % 5; }
  std::mt19937 m_random;
};

}  // namespace

// Mixtures of voxels that err one by one state what voxels are right, and cells are right more
// often.
TEST(CompressedClasses, areStatedAsOftenAsTheyAreRight) {
  for (const double wrong : {0.1, 0.2, 0.3}) {
    FloorOfCells floor(7);
    SemanticOcTree map(kTreeResolution, numberedClasses(kTreeClasses)), grown = map;
    AbstractionOptions options = someOptions(10);
    options.blockSize = 8 * kTreeResolution;
    setAbstraction(grown, options);
    Calibrator calibrator(kTreeResolution, kTreeClasses);
    for (int i = 0; i < 6; ++i) {
      const PosedCloud scan = floor.scan(wrong);
      calibrator.add(scan.cloud, scan.T_map_sensor);
      map.insert(scan.cloud, scan.T_map_sensor);
      grown.insert(scan.cloud, scan.T_map_sensor);
    }
    const Calibration fit = calibrator.fit(map);
    for (SemanticOcTree* m : {&map, &grown}) m->setCalibration(fit);
    setAbstraction(map, options);
    SemanticOcTree compressed = Abstraction(map).compressedMap();
    const SemanticOcTree step = Abstraction(grown).compressedMap();
    EXPECT_TRUE(compressed == step);
    EXPECT_EQ(compressed.filterParameters().calibration.power,
              step.filterParameters().calibration.power);
    const double gap = FloorOfCells::gap(compressed);
    EXPECT_NEAR(gap, 0, 0.03) << wrong;
    compressed.setCalibration({});
    EXPECT_LT(FloorOfCells::gap(compressed), gap - 0.008) << wrong;
  }
}
