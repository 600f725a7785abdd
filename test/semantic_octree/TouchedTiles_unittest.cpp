#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "Voxels.h"

using namespace semantic_octree;

namespace {

using Tiles = std::set<VoxelId>;  // lowest voxel of each

std::map<VoxelId, std::map<VoxelId, std::vector<double>>> voxelsByTile(const SemanticOcTree& map) {
  std::map<VoxelId, std::map<VoxelId, std::vector<double>>> tiles;
  for (const auto& [v, p] : voxelsOf(map)) tiles[{v[0] & ~7, v[1] & ~7, v[2] & ~7}][v] = p;
  return tiles;
}

Tiles tilesThatDiffer(const SemanticOcTree& before, const SemanticOcTree& after) {
  const auto a = voxelsByTile(before);
  Tiles different;
  for (const auto& [tile, voxels] : voxelsByTile(after)) {
    const auto old = a.find(tile);
    if (old == a.end() || old->second != voxels) different.insert(tile);
  }
  return different;
}

Tiles asSet(const std::vector<octomap::OcTreeKey>& keys) {
  Tiles tiles;
  for (const octomap::OcTreeKey& k : keys) tiles.insert(voxelAt(k[0], k[1], k[2]));
  return tiles;
}

}  // namespace

TEST(TouchedTiles, areThoseInWhichAVoxelChanged) {
  for (const int threads : {1, 2}) {
    std::mt19937 random(3);
    SemanticOcTree map(0.4, numberedClasses(5));
    InsertionOptions options;
    options.threads = threads;
    EXPECT_TRUE(map.takeTouchedTiles().empty());
    for (int i = 0; i < 6; ++i) {
      const SemanticOcTree before = map;
      const PosedCloud scan = randomScan(random);
      map.insert(scan.cloud, scan.T_map_sensor, options);
      EXPECT_EQ(asSet(map.takeTouchedTiles()), tilesThatDiffer(before, map)) << "scan " << i;
      EXPECT_TRUE(map.takeTouchedTiles().empty());
    }
  }
}

TEST(TouchedTiles, areAllThoseInALargerCubeThatChangesAsAWhole) {
  PosedCloud sphere;
  for (double up = -1.55; up < 1.56; up += 0.02)
    for (double around = 0; around < 6.28; around += 0.02)
      sphere.cloud.points.emplace_back(13 * std::cos(up) * std::cos(around),
                                       13 * std::cos(up) * std::sin(around), 13 * std::sin(up));
  SemanticOcTree map(0.4, numberedClasses(5));
  map.takeTouchedTiles();
  for (int i = 0; i < 2; ++i) {
    const SemanticOcTree before = map;
    map.insert(sphere.cloud, sphere.T_map_sensor);
    ASSERT_NE(map.search(octomap::OcTreeKey(32776, 32776, 32776), 12), nullptr);
    EXPECT_TRUE(map.search(octomap::OcTreeKey(32776, 32776, 32776), 12)->isLeaf());
    EXPECT_EQ(asSet(map.takeTouchedTiles()), tilesThatDiffer(before, map));
  }
}

TEST(TouchedTiles, areAllKnownOnesAtFirstAndAddUpUntilTheyAreTaken) {
  std::mt19937 random(4);
  SemanticOcTree map(0.4, numberedClasses(5));
  const SemanticOcTree empty = map;
  const PosedCloud first = randomScan(random), second = randomScan(random);
  map.insert(first.cloud, first.T_map_sensor);
  EXPECT_EQ(asSet(map.takeTouchedTiles()), tilesThatDiffer(empty, map));
  const SemanticOcTree before = map;
  for (int i = 0; i < 2; ++i) map.insert(second.cloud, second.T_map_sensor);
  const auto touched = asSet(map.takeTouchedTiles()), different = tilesThatDiffer(before, map);
  EXPECT_TRUE(std::includes(touched.begin(), touched.end(), different.begin(), different.end()));
}

TEST(TouchedTiles, areForgottenWithTheMap) {
  std::mt19937 random(5);
  SemanticOcTree map(0.4, numberedClasses(5));
  map.takeTouchedTiles();
  const PosedCloud scan = randomScan(random);
  map.insert(scan.cloud, scan.T_map_sensor);
  map.clear();
  EXPECT_TRUE(map.takeTouchedTiles().empty());
}
