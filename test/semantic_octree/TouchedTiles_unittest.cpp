#include <gtest/gtest.h>

#include <set>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

using TileKey = std::array<int, 3>;

/** Log-odds of every known voxel by tile, and what its class record says. */
std::map<TileKey, std::map<TileKey, std::vector<double>>> voxelsByTile(const SemanticOcTree& map) {
  std::map<TileKey, std::map<TileKey, std::vector<double>>> tiles;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int edge = 1 << (16 - leaf.getDepth());
    for (int x = first[0]; x < first[0] + edge; ++x)
      for (int y = first[1]; y < first[1] + edge; ++y)
        for (int z = first[2]; z < first[2] + edge; ++z)
          tiles[{x & ~7, y & ~7, z & ~7}][{x, y, z}] = map.distribution(*leaf);
  }
  return tiles;
}

std::set<TileKey> tilesThatDiffer(const SemanticOcTree& before, const SemanticOcTree& after) {
  const auto a = voxelsByTile(before);
  std::set<TileKey> different;
  for (const auto& [tile, voxels] : voxelsByTile(after)) {
    const auto old = a.find(tile);
    if (old == a.end() || old->second != voxels) different.insert(tile);
  }
  return different;
}

std::set<TileKey> asSet(const std::vector<octomap::OcTreeKey>& keys) {
  std::set<TileKey> tiles;
  for (const octomap::OcTreeKey& key : keys) tiles.insert({key[0], key[1], key[2]});
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
