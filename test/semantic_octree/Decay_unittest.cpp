#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <octomap/OcTree.h>
#include <semantic_abstraction/Abstraction.h>

#include <cmath>

#include "AgingMaps.h"
#include "Voxels.h"

using namespace aging_maps;

namespace {

constexpr double kTick = 1.0 / kUnitsPerLogOdds;

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

TEST(Decay, leadsToUnknownNeverToFree) {
  SemanticOcTree map = randomMap(2, classes(false));
  const auto before = voxelsOf(map);
  for (int i = 0; i < 40; ++i) {
    map.age(0.75);
    for (const auto& [id, p] : voxelsOf(map))
      ASSERT_EQ(p[0] < 0.5, before.at(id)[0] < 0.5) << "a voxel that was occupied is free";
  }
  const MapContents contents = contentsOf(map);
  for (const int id : {1, 2, 3}) EXPECT_EQ(contents.voxelsOfClass[id], 0u) << id;
  for (const int id : {4, 5}) EXPECT_GT(contents.voxelsOfClass[id], 10u) << id;
  EXPECT_EQ(contents.freeVoxels, contentsOf(randomMap(2, classes(false))).freeVoxels);
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

TEST(Decay, allThatHasAHalfLifeGoesInTheEnd) {
  SemanticOcTree map = randomMap(50, classes());
  ClassTable all = classes();
  all.setHalfLife(4, 100);
  map.setHalfLives(all);
  map.age(1e9);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    EXPECT_TRUE(map.isNodeOccupied(*leaf));
    EXPECT_EQ(halfLifeOf(map, *leaf), kForever) << "only what never had a class stays";
  }
}
