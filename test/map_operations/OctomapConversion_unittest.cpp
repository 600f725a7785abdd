#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <semantic_types/ClassTable.h>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

SemanticOcTree someMap(unsigned seed, bool labeled = true) {
  std::mt19937 random(seed);
  semantic_types::ClassTable classes;
  for (int id = 1; id <= 5; ++id)
    classes.add("class " + std::to_string(id),
                {static_cast<std::uint8_t>(40 * id), 7, static_cast<std::uint8_t>(id)});
  SemanticOcTree map(0.4, classes);
  for (int i = 0; i < 4; ++i) {
    PosedCloud scan = randomScan(random);
    if (!labeled) scan.cloud.classes.clear();
    map.insert(scan.cloud, scan.T_map_sensor);
  }
  return map;
}

}  // namespace

TEST(OctomapConversion, ofAMapWithoutClassesBringsItBackToTheLastBit) {
  const SemanticOcTree map = someMap(5, false);
  EXPECT_TRUE(fromOcTree(*toOcTree(map), map.classes()) == map);
}

TEST(OctomapConversion, hasTheColorsOfTheLikeliestClasses) {
  const SemanticOcTree map = someMap(6);
  const auto tree = toColorOcTree(map);
  std::size_t occupied = 0;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!map.isNodeOccupied(*leaf)) continue;
    ++occupied;
    const auto is = tree->search(leaf.getKey(), leaf.getDepth())->getColor();
    const auto expected = colorOf(map.query(*leaf).likeliestClass, map.classes());
    ASSERT_TRUE(is.r == expected.r && is.g == expected.g && is.b == expected.b);
  }
  EXPECT_GT(occupied, 100u);
}

TEST(OctomapConversion, ofAVoxelOfEvenOddsIsFree) {
  FilterParameters even;  // a hit and a miss cancel out
  even.hitProbability = 0.75;
  even.falseAlarmProbability = 0.25;
  SemanticOcTree map(1.0, numberedClasses(1), even);
  for (const float x : {2.5f, 5.5f}) {
    LabeledCloud cloud;
    cloud.points = {{x, 0.5f, 0.5f}};
    map.insert(cloud, Eigen::Isometry3d::Identity());
  }
  const octomap::OcTreeKey key = map.coordToKey(2.5, 0.5, 0.5);
  EXPECT_EQ(map.search(key).getLogOdds(), 0);
  const auto tree = toOcTree(map);
  EXPECT_FALSE(tree->isNodeOccupied(tree->search(key)));
}

TEST(OctomapConversion, ofAnEmptyMapIsEmpty) {
  const SemanticOcTree empty(0.4, semantic_types::ClassTable(someMap(1).classes()));
  EXPECT_EQ(toOcTree(empty)->size(), 0u);
  EXPECT_EQ(toColorOcTree(empty)->size(), 0u);
  EXPECT_TRUE(fromOcTree(octomap::OcTree(0.4), empty.classes()) == empty);
}
