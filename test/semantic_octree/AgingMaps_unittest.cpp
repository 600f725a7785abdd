// What follows a map that ages: files, G-values, changes, sums.
#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/MapFollower.h>

#include <cmath>
#include <set>

#include "AgingMaps.h"
#include "FollowedTree.h"
#include "Voxels.h"

using namespace aging_maps;

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

TEST(Decay, aFileWithAClockIsRefusedCutOrAltered) {
  SemanticOcTree map(0.4, classes());
  map.age(1.5);
  const std::string bytes = bytesOf(map);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    std::istringstream cut(bytes.substr(0, size));
    EXPECT_THROW(readTree(cut), std::runtime_error) << size;
    std::string other = bytes;
    other[size] = static_cast<char>(other[size] ^ 0x40);
    std::istringstream altered(other);
    EXPECT_THROW(readTree(altered), std::runtime_error) << size;
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

TEST(Decay, tellsWhichTilesChanged) {
  SemanticOcTree map = randomMap(40, classes());
  MapFollower follower = map.follow();
  follower.skipTiles();
  for (int i = 0; i < 12; ++i) {
    const auto before = voxelsOf(map);
    map.age(0.3);
    const auto after = voxelsOf(map);
    std::set<VoxelId> tiles, told;
    for (const auto& [v, p] : before)
      if (const auto it = after.find(v); it == after.end() || it->second != p)
        tiles.insert({v[0] & ~7, v[1] & ~7, v[2] & ~7});
    for (const auto& k : follower.tiles().tiles) told.insert(voxelAt(k[0], k[1], k[2]));
    ASSERT_EQ(told, tiles) << i;
  }
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
