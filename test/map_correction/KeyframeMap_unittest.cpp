#include <gtest/gtest.h>
#include <semantic_octree/MapFollower.h>

#include <algorithm>

#include "KeyframeScans.h"
#include "PackedScan.h"
#include "TemporaryFolder.h"

using namespace keyframe_scans;

/** Limits that are never met, labels that never disagree: then sums are all there is. */
TEST(KeyframeMap, awayFromTheLimitsTheOrderOfScansLeavesNoTrace) {
  const Variant variant{"wide"};
  FilterParameters wide;
  wide.minOccupancy = 1e-9;
  wide.maxProbability = 1 - 1e-9;
  wide.accuracy = 0.4;  // the more a label says, the fewer reach the limits
  std::mt19937 random(5);
  RandomScanOptions options;
  options.classes = 3;
  options.sensorSpread = 0.3;
  Scans forward;
  for (KeyframeId id = 0; id < 6; ++id) {
    forward.poses.push_back(Eigen::Isometry3d::Identity());
    forward.all.push_back({id, randomScan(random, options), 0});
  }
  Scans backward = forward;
  std::reverse(backward.all.begin(), backward.all.end());
  EXPECT_TRUE(forward.mappedFromScratch(variant, wide) ==
              backward.mappedFromScratch(variant, wide));
  EXPECT_FALSE(forward.mappedFromScratch(variant) == backward.mappedFromScratch(variant));
}

TEST(KeyframeMap, changesOnlyTilesInWhichAScanSeesSomethingElse) {
  std::mt19937 random(3);
  SemanticOcTree map = emptyMap({"hard"});
  KeyframeMap keyframes(map);
  for (int i = 0; i < 3; ++i) {
    const KeyframeId id = keyframes.begin(Eigen::Isometry3d(Eigen::Translation3d(20 * i, 0, 0)));
    ASSERT_EQ(id, std::size_t(i));
    keyframes.insert(randomScan(random).cloud, Eigen::Isometry3d::Identity());
  }
  MapFollower follower = map.follow();
  follower.skipTiles();
  keyframes.move({{1, keyframes.pose(1)}});
  EXPECT_TRUE(follower.tiles().tiles.empty());
  keyframes.move({{1, Eigen::Isometry3d(Eigen::Translation3d(20.2, 0, 0))}});
  const auto tiles = follower.tiles().tiles;
  EXPECT_GT(tiles.size(), 10u);
  for (const octomap::OcTreeKey& tile : tiles)
    EXPECT_NEAR(map.keyToCoord(tile).x(), 20, 11) << "where the others are, nothing changes";
  const SemanticOcTree before = map;
  keyframes.remove({0});
  EXPECT_LT(map.size(), before.size());
}

TEST(KeyframeMap, correctsTilesThatScansShareAtTheirFarthest) {
  const Variant variant{"row"};
  std::mt19937 random(8);
  SemanticOcTree map = emptyMap(variant);
  KeyframeMap keyframes(map);
  Scans scans;
  RandomScanOptions options;
  options.sensorSpread = 0;
  double x = 0;  // beams reach 6 m, tiles are of 3.2 m
  for (KeyframeId id = 0; id < 30; ++id, x += between(random, 11, 15)) {
    scans.poses.push_back(Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)));
    scans.all.push_back({id, randomScan(random, options), 0});
    keyframes.begin(scans.poses[id]);
    keyframes.insert(scans.all[id].scan.cloud, scans.all[id].scan.T_map_sensor, optionsOf(variant));
  }
  for (KeyframeId id = 0; id < 30; ++id) {
    scans.poses[id].translation() += randomPose(random, 0.5).translation();
    keyframes.move({{id, scans.poses[id]}});
    ASSERT_TRUE(map == scans.mappedFromScratch(variant)) << id;
  }
}

/** Nothing else changes that would lead the eye there. */
TEST(KeyframeMap, tellsOfABlockThatIsNotWorthItsPriceAnyMore) {
  Variant variant{"alone"};
  variant.blockSize = 1.6;
  SemanticOcTree map = emptyMap(variant);
  KeyframeMap keyframes(map);
  const auto insert = [&](float place, semantic_types::ClassId id) {
    LabeledCloud cloud;
    cloud.points = {{place, place, place}};
    cloud.classes = {id};
    keyframes.begin(Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.1, 0.1)));
    keyframes.insert(cloud, Eigen::Isometry3d::Identity());
  };
  insert(0.9f, 2);
  insert(0.5f, 1);
  LeafFollower follower(map);
  follower.skipLeaves();
  const std::size_t before = Abstraction(map).leaves().size();
  keyframes.remove({1});
  EXPECT_LT(Abstraction(map).leaves().size(), before);
  EXPECT_FALSE(follower.leaves().removed.empty());
}

TEST(KeyframeMap, refusesWhatIsNotThereAndStaysAsItWas) {
  std::mt19937 random(3);
  SemanticOcTree map = emptyMap({"hard"});
  KeyframeMap keyframes(map);
  const PosedCloud scan = randomScan(random);
  EXPECT_THROW(keyframes.insert(scan.cloud, scan.T_map_sensor), std::logic_error);
  keyframes.begin(Eigen::Isometry3d::Identity());
  keyframes.insert(scan.cloud, scan.T_map_sensor);
  const SemanticOcTree before = map;
  const Eigen::Isometry3d outside(Eigen::Translation3d(1e6, 0, 0));
  EXPECT_TRUE(contains(errorOf([&] { keyframes.remove({1}); }), "no keyframe 1"));
  EXPECT_TRUE(contains(errorOf([&] { keyframes.move({{2, outside}}); }), "no keyframe 2"));
  EXPECT_THROW(keyframes.move({{0, outside}}), std::out_of_range);
  EXPECT_THROW(keyframes.insert(scan.cloud, outside), std::out_of_range);
  EXPECT_EQ(keyframes.numScans(), 1u);
  EXPECT_TRUE(keyframes.pose(0).isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(map == before);
  keyframes.remove({0});
  EXPECT_TRUE(map.empty());
  EXPECT_THROW(keyframes.insert(scan.cloud, scan.T_map_sensor), std::logic_error);
  EXPECT_THROW(keyframes.remove({0}), std::out_of_range);
  SemanticOcTree full = before;
  EXPECT_THROW(KeyframeMap other(full), std::invalid_argument);
}

TEST(KeyframeMap, keepsItsScansWhereItIsToldTo) {
  std::mt19937 random(3);
  const PosedCloud scan = randomScan(random);
  const TemporaryFolder folder;
  SemanticOcTree map = emptyMap({"hard"});
  {
    KeyframeMap keyframes(map, folder.path());
    keyframes.begin(Eigen::Isometry3d::Identity());
    keyframes.insert(scan.cloud, scan.T_map_sensor);
    const auto file = std::filesystem::directory_iterator(folder.path());
    EXPECT_GT(file->file_size(), 13 * scan.cloud.size());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

using namespace semantic_octree;

namespace {

TEST(PackedScan, hasTheReliabilityOfLabelsAsPartOfWhatAScanSawInEachTile) {
  const auto scanOfTwoTiles = [](const LabelReliability& labels) {
    PackedScan scan(false, labels);
    for (const std::uint64_t code : {3, 8}) scan.add(code, {1});
    return scan;
  };
  const PackedScan scan = scanOfTwoTiles({0.9, 0.5});
  EXPECT_EQ(differingTiles(scan, scanOfTwoTiles({0.9, 0.5})), TileCodes());
  EXPECT_EQ(differingTiles(scan, scanOfTwoTiles({0.9, 0.4})), (TileCodes{3, 8}));
}

}  // namespace
