#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <rapidcheck.h>
#include <semantic_octree/Keys.h>

#include <cstdlib>

#include "SmallScans.h"

using namespace semantic_octree;

namespace {

/** RapidCheck draws the same cases in every run. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

constexpr double kVoxel = 0.25;  // m; all borders are floats, OctoMap's own precision

/** Keys from one end of the map to the other. */
rc::Gen<int> anyKey() { return rc::gen::inRange(0, kNumKeys); }
rc::Gen<int> anyDepth() { return rc::gen::inRange(0, kTreeDepth + 1); }

constexpr double kVoxelSizes[] = {0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 1.0 / 3, 0.35, 0.4};

/** Calls f(coordinate) for voxels' borders (meters), as products and as decimals, and
 * what lies next to them. */
template <typename F>
void forCoordinatesAtBorders(double voxel, int numKeys, const F& f) {
  for (int key = -numKeys; key <= numKeys; ++key)
    for (const double border : {key * voxel, key / 20.0})
      for (const double x :
           {std::nextafter(border, -HUGE_VAL), border, std::nextafter(border, HUGE_VAL)})
        f(x);
}

/** Key of the voxel in which the only return of a scan ends, along x. */
int keyOfReturn(double voxelSize, double sensor, float point) {
  PosedCloud scan;
  scan.T_map_sensor.translation().x() = sensor;
  scan.cloud.points.emplace_back(point, 0, 0);
  SemanticOcTree map(voxelSize, numberedClasses(1));
  map.insert(scan.cloud, scan.T_map_sensor);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf)
    if (map.isNodeOccupied(*leaf)) return leaf.getKey()[0];
  return -1;
}

}  // namespace

TEST(Keys, areThoseOfOctoMap) {
  EXPECT_TRUE(rc::check([] {
    const octomap::OcTree map(kVoxel);
    const int key = *anyKey(), depth = *anyDepth();
    const auto octomaps = static_cast<octomap::key_type>(key);
    RC_ASSERT(centerOf(key, kVoxel) == map.keyToCoord(octomaps));
    RC_ASSERT(keyOf(centerOf(key, kVoxel), kVoxel) == key);
    RC_ASSERT(map.coordToKey(lowerBorderOf(key, kVoxel)) == octomaps);
    if (depth > 0)  // OctoMap says 0 for the root, which is right, in another way
      RC_ASSERT(centerOf(key, kVoxel, depth) == map.keyToCoord(octomaps, unsigned(depth)));
    RC_ASSERT(octomapKey(key, 0, 65535) == octomap::OcTreeKey(octomaps, 0, 65535));
  }));
}

TEST(Keys, aCubeHoldsTheVoxelsFromItsLowestKeyOn) {
  EXPECT_TRUE(rc::check([] {
    const int key = *anyKey(), depth = *anyDepth();
    const int lowest = lowestKeyAtDepth(key, depth), edge = edgeAtDepth(depth);
    RC_ASSERT(lowest % edge == 0);
    RC_ASSERT(lowest <= key && key < lowest + edge);
    const double border = lowerBorderOf(lowest, kVoxel);
    RC_ASSERT(centerOf(key, kVoxel, depth) == border + edge * kVoxel / 2);
  }));
}

TEST(Keys, ofAnyCoordinateAreTheSameByEveryWay) {
  for (const double voxel : kVoxelSizes) {
    const SemanticOcTree map(voxel, numberedClasses(1));
    const octomap::OcTree octomaps(voxel);
    forCoordinatesAtBorders(voxel, 1000, [&](double x) {
      const int key = keyOf(x, voxel);
      ASSERT_EQ(octomaps.coordToKey(x), key) << x << " at " << voxel;
      ASSERT_EQ(map.coordToKey(x, x, x), octomapKey(key, key, key)) << x << " at " << voxel;
      octomap::OcTreeKey checked;
      ASSERT_TRUE(map.coordToKeyChecked(x, x, x, checked));
      ASSERT_EQ(checked, octomapKey(key, key, key)) << x << " at " << voxel;
      const auto single = static_cast<float>(x);
      const octomap::point3d point(single, single, single);
      ASSERT_EQ(map.coordToKey(point)[2], keyOf(single, voxel)) << x << " at " << voxel;
      ASSERT_TRUE(map.coordToKeyChecked(point, checked) && checked == map.coordToKey(point));
    });
  }
}

TEST(Keys, ofAnyCoordinateAreThoseThatScansFind) {
  for (const double voxel : kVoxelSizes)
    forCoordinatesAtBorders(voxel, 60, [&](double x) {
      const auto single = static_cast<float>(x);
      ASSERT_EQ(keyOfReturn(voxel, 0, single), keyOf(single, voxel)) << single << " at " << voxel;
      ASSERT_EQ(keyOfReturn(voxel, x, 0), keyOf(x, voxel)) << x << " at " << voxel;
    });
}
