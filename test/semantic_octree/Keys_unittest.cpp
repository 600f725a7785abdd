#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <rapidcheck.h>
#include <semantic_octree/Keys.h>

#include <cstdlib>

using namespace semantic_octree;

namespace {

/** RapidCheck draws the same cases in every run. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

constexpr double kVoxel = 0.25;  // m; all borders are floats, OctoMap's own precision

/** Keys from one end of the map to the other. */
rc::Gen<int> anyKey() { return rc::gen::inRange(0, kNumKeys); }
rc::Gen<int> anyDepth() { return rc::gen::inRange(0, kTreeDepth + 1); }

}  // namespace

TEST(Keys, coordinatesBelowZeroAreRoundedDown) {
  EXPECT_EQ(keyOf(0, kVoxel), 32768);
  EXPECT_EQ(keyOf(-0.01, kVoxel), 32767);
  EXPECT_EQ(keyOf(-0.25, kVoxel), 32767);
  EXPECT_EQ(keyOf(-0.26, kVoxel), 32766);
  EXPECT_EQ(keyOf(0.24, kVoxel), 32768);
  EXPECT_EQ(keyOf(-8192, kVoxel), 0);
  EXPECT_LT(keyOf(-8192.1, kVoxel), 0);
  EXPECT_EQ(keyOf(8192, kVoxel), kNumKeys);
}

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
