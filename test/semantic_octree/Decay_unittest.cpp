// Maps in which some classes fade, and what follows them: files, G-values, changes, sums.
#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/TreeFile.h>

#include <cmath>
#include <sstream>

#include "FollowedTree.h"
#include "Voxels.h"

using namespace semantic_octree;
using semantic_types::kForever;

namespace {

constexpr int kClasses = 5;

/** Seconds: free space, classes 1 to 5. Class 4 stays, class 5 goes slowly. */
constexpr double kHalfLives[kClasses + 1] = {8, 1, 2.5, 4, kForever, 3e7};

ClassTable classes(bool freeDecays = true) {
  ClassTable table = numberedClasses(kClasses);
  for (int id = freeDecays ? 0 : 1; id <= kClasses; ++id)
    table.setHalfLife(static_cast<ClassId>(id), kHalfLives[id]);
  return table;
}

AbstractionOptions abstraction(double alpha = 0.01) {
  AbstractionOptions options;
  options.weights = {
      {tree_abstraction::relevant("1", 1, {1}), tree_abstraction::irrelevant("2", 0.5, {2})},
      alpha};
  return options;
}

void insertRandom(SemanticOcTree& map, std::mt19937& random, double secondsSince = 0) {
  RandomScanOptions scans;
  scans.softLabels = random() % 4 == 0;
  const PosedCloud scan = randomScan(random, scans);
  InsertionOptions options;
  options.maxRange = 6;
  map.insert(scan.cloud, scan.T_map_sensor, options, secondsSince);
}

SemanticOcTree randomMap(unsigned seed, const ClassTable& table, bool pruning = true) {
  std::mt19937 random(seed);
  SemanticOcTree map(0.4, table);
  map.setPruning(pruning);
  for (int i = 0; i < 4; ++i) insertRandom(map, random, 0.7);
  return map;
}

std::string bytesOf(const SemanticOcTree& map) {
  std::ostringstream out;
  writeTree(out, map);
  return out.str();
}

SemanticOcTree reloaded(const SemanticOcTree& map) {
  std::istringstream in(bytesOf(map));
  return readTree(in);
}

/** Half-life of a leaf, by what the page on decay says. */
double halfLifeOf(const SemanticOcTree& map, const SemanticOcTreeNode& leaf) {
  if (!map.isNodeOccupied(leaf)) return kHalfLives[0];
  const auto belief = map.belief(leaf);
  double highest = belief.rest;
  ClassId likeliest = kNoClass;
  for (int i = 0; i < belief.count; ++i)
    if (belief.logOdds[i] > highest) highest = belief.logOdds[i], likeliest = belief.ids[i];
  return likeliest == kNoClass ? kForever : kHalfLives[likeliest];
}

/** How much log-odds shrink by from one time to another, seconds. */
double factor(double halfLife, double from, double to) {
  if (halfLife == kForever) return 1;
  const double step = halfLife / 8;
  return std::pow(0.5, (std::floor(to / step + 1e-9) - std::floor(from / step + 1e-9)) / 8);
}

/** ln p, as far as it goes. */
double safeLog(double p) { return std::log(std::max(p, 1e-300)); }

/** Compares a voxel that is known with what its distribution was. \param s see factor() */
void expectShrunk(const std::vector<double>& before, const std::vector<double>& after, double s) {
  const double v = safeLog(1 - before[0]) - safeLog(before[0]);
  const double w = safeLog(1 - after[0]) - safeLog(after[0]);
  ASSERT_NEAR(w, s * v, s == 1 ? 1e-9 : 15 * kTick);
  for (std::size_t k = 2; k < before.size(); ++k) {
    const double difference = safeLog(before[k]) - safeLog(before[1]);
    ASSERT_NEAR(safeLog(after[k]) - safeLog(after[1]), s * difference, s == 1 ? 1e-9 : 27 * kTick);
  }
}

}  // namespace

TEST(Decay, logOddsShrinkByTheHalfLifeOfTheLikeliestClass) {
  for (const double seconds : {0.13, 1.0, 3.7, 12.0, 60.0}) {
    const SemanticOcTree before = randomMap(1, classes());
    SemanticOcTree after = before;
    after.age(seconds);
    int kept = 0, gone = 0, same = 0;
    for (auto leaf = before.begin_leafs(); leaf != before.end_leafs(); ++leaf) {
      const double s = factor(halfLifeOf(before, *leaf), before.clock(), after.clock());
      const double left = std::fabs(s * leaf->getLogOdds());
      const auto now = after.search(leaf.getKey());
      if (s < 1 && std::fabs(left - 0.1) < 15 * kTick) continue;
      if (s < 1 && left < 0.1) {
        ASSERT_FALSE(now) << "log-odds " << leaf->getLogOdds() << " times " << s;
        ++gone;
        continue;
      }
      ASSERT_TRUE(now);
      expectShrunk(before.distribution(*leaf), after.distribution(now), s);
      ++(s == 1 ? same : kept);
    }
    EXPECT_GT(same, 100);
    EXPECT_GT(seconds > 50 ? gone : kept, 100) << seconds;
  }
}

TEST(Decay, manyShortTimesDoWhatALongOneDoes) {
  std::mt19937 random(3);
  for (unsigned seed = 10; seed < 16; ++seed) {
    SemanticOcTree once = randomMap(seed, classes(), seed % 2 == 0);
    if (seed % 3 == 0) setAbstraction(once, abstraction());
    SemanticOcTree often = once;
    double left = 6;
    while (left > 0) {
      const double part = std::min(left, std::round(between(random, 0, 500)) / 1000);
      often.age(part);
      left = std::round((left - part) * 1000) / 1000;
    }
    once.age(6);
    ASSERT_TRUE(often == once) << seed;
    EXPECT_EQ(often.memoryUsage(), once.memoryUsage());
    EXPECT_LT(once.getNumLeafNodes(), randomMap(seed, classes(), seed % 2 == 0).getNumLeafNodes());
  }
}

TEST(Decay, prunedMapsAgeAsThoseThatAreNot) {
  SemanticOcTree pruned = randomMap(4, classes()), plain = randomMap(4, classes(), false);
  for (SemanticOcTree* map : {&pruned, &plain}) {
    map->age(2.2);
    std::mt19937 random(5);
    insertRandom(*map, random, 0.4);
    map->age(1.1);
  }
  EXPECT_EQ(voxelsOf(pruned), voxelsOf(plain));
  EXPECT_LT(pruned.size(), plain.size());
}

TEST(Decay, whatAgreesAfterwardsIsPruned) {
  const auto unlike = [](float x, float y, float z) {
    return (x > 0) != (y > 0) && z > 0 ? -1000.f : -1001.f;
  };
  octomap::OcTree octree(0.5);
  for (float x = -3.75f; x < 4; x += 0.5f)
    for (float y = -3.75f; y < 4; y += 0.5f)
      for (float z = -3.75f; z < 4; z += 0.5f)
        octree.setNodeValue(x, y, z, unlike(x, std::fabs(x - y) - 0.6f, z) / kUnitsPerLogOdds);
  octree.updateInnerOccupancy();
  SemanticOcTree map = fromOcTree(octree, classes());
  EXPECT_GT(map.getNumLeafNodes(), 500u);
  map.age(1);
  EXPECT_EQ(map.getNumLeafNodes(), 8u) << "what met at the origin";
  EXPECT_EQ(map.search(map.coordToKey(1, 1, 1)).getLogOdds(), -917.f / kUnitsPerLogOdds);
}

TEST(Decay, mapsWithoutHalfLivesStayAsTheyAreAlsoInFiles) {
  SemanticOcTree map = randomMap(6, numberedClasses(kClasses));
  const std::string before = bytesOf(map);
  map.age(1e9);
  EXPECT_EQ(map.clock(), 0);
  EXPECT_EQ(bytesOf(map), before);
}

TEST(Decay, aMapThatIsLoadedGoesOnWhereItStopped) {
  for (unsigned seed = 20; seed < 24; ++seed) {
    std::mt19937 random(seed);
    SemanticOcTree map = randomMap(seed, classes());
    map.age(0.33);
    SemanticOcTree loaded = reloaded(map);
    ASSERT_TRUE(loaded == map);
    EXPECT_EQ(loaded.clock(), map.clock());
    EXPECT_EQ(loaded.classes().halfLife(2), 2.5);
    EXPECT_EQ(loaded.classes().halfLife(kNoClass), 8);
    for (SemanticOcTree* m : {&map, &loaded}) {
      std::mt19937 same(seed + 100);
      for (int i = 0; i < 3; ++i) insertRandom(*m, same, 0.41);
    }
    ASSERT_TRUE(loaded == map);
  }
}

TEST(Decay, mixturesGValuesAndTheCompressedTreesChangeFollow) {
  for (unsigned seed = 30; seed < 36; ++seed) {
    std::mt19937 random(seed);
    SemanticOcTree map(0.4, classes(seed % 2 == 0));
    map.setPruning(seed % 3 != 0);
    AbstractionOptions options = abstraction(0.01 + 0.05 * (seed - 30));
    if (seed % 2 == 0) options.blockSize = 1.6;  // of 4 x 4 x 4 voxels
    setAbstraction(map, options);
    FollowedTree told(map);
    for (int i = 0; i < 30; ++i) {
      i % 10 == 0 ? insertRandom(map, random, 0.2) : map.age(between(random, 0, 0.7));
      told.follow();
      ASSERT_FALSE(HasFailure()) << seed << ", " << i;
      SemanticOcTree anew = reloaded(map);
      setAbstraction(anew, options);
      ASSERT_TRUE(map == anew) << seed << ", " << i;
    }
  }
}

/** Nothing else changes that would lead the eye there. */
TEST(Decay, aBlockThatIsNotWorthItsPriceAnyMoreIsTold) {
  SemanticOcTree map(0.5, classes(false));
  AbstractionOptions options = abstraction(0.01);
  options.blockSize = 2;
  setAbstraction(map, options);
  LabeledCloud cloud;
  cloud.points = {{0.25f, 0.25f, 0.25f}, {1.25f, 1.25f, 1.25f}};
  cloud.classes = {1, 2};
  map.insert(cloud, Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.1, 0.1)));
  LeafFollower follower(map);
  follower.skipLeaves();
  const std::size_t before = Abstraction(map).leaves().size();
  map.age(20);
  EXPECT_LT(Abstraction(map).leaves().size(), before);
  EXPECT_FALSE(follower.leaves().removed.empty());
}

TEST(Decay, sumsHaveTheLatestClock) {
  SemanticOcTree early = randomMap(60, classes()), late = randomMap(61, classes());
  late.age(5);
  const SemanticOcTree sum = merged({&early, &late});
  EXPECT_EQ(sum.clock(), late.clock());
  EXPECT_TRUE(sum == merged({&late, &early}));
  EXPECT_EQ(coarsened(late, 1).clock(), late.clock());
}

TEST(Decay, refusesTimesThatCannotBe) {
  SemanticOcTree map = randomMap(70, classes());
  const std::string before = bytesOf(map);
  for (const double seconds : {-1.0, 1.1e9, std::nan("")})
    EXPECT_THROW(map.age(seconds), std::invalid_argument) << seconds;
  EXPECT_EQ(bytesOf(map), before);
  SemanticOcTree empty(0.4, classes());
  for (int i = 0; i < 6; ++i) empty.age(1e9);
  EXPECT_THROW(empty.age(1e9), std::out_of_range);
}
