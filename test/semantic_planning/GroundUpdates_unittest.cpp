// Ground that follows its map, and ground of parts of a map, against ground that is read anew.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>

#include "PaintedGround.h"
#include "ground/GroundTiles.h"

using namespace painted_ground;

namespace {

void expectSame(const Ground& a, const Ground& b, int reach = 60) {
  for (int x = -reach; x < reach; ++x)
    for (int y = -reach; y < reach; ++y) {
      const Column c{kOrigin + x, kOrigin + y};
      const SurfaceRange s = a.surfaces(c), t = b.surfaces(c);
      ASSERT_TRUE(std::equal(s.begin(), s.end(), t.begin(), t.end())) << x << ' ' << y;
    }
}

/** The ground of a map, which is told where that changed. */
struct FollowingGround {
  explicit FollowingGround(SemanticOcTree& followed, const VehicleOptions& v = smallVehicle(),
                           const GroundOptions& o = withoutGapFills())
      : map(followed), vehicle(v), options(o) {
    follower.skipTiles();
  }
  std::vector<Column> update() { return ground.update(follower.tiles()); }
  void expectReadAnew(int reach = 60) const {
    expectSame(ground, groundOf(map, vehicle, options), reach);
  }

  SemanticOcTree& map;
  VehicleOptions vehicle;
  GroundOptions options;
  semantic_octree::MapFollower follower = map.follow();
  Ground ground = groundOf(map, vehicle, options);
};

}  // namespace

TEST(Ground, afterUpdatesItIsTheGroundReadAnew) {
  PaintedWorld world;
  addRubble(world, 2, 600);
  world.floor(-6, 6, -6, 6, PaintedWorld::Road);
  FollowingGround ground(world.map(), {}, {});
  for (unsigned round = 0; round < 8; ++round) {
    addRubble(world, 100 + round, 25);
    world.map({0.05 + 0.3 * round, 0.05, 20});
    ground.update();
    ground.expectReadAnew();
  }
}

TEST(Ground, keepsLittleOfAMapThatMayChange) {
  const auto heap = [] {
    const struct mallinfo2 use = mallinfo2();
    return use.uordblks + use.hblkhd;
  };
  PaintedWorld world;
  const SemanticOcTree& map = world.floor(-30, 30, -30, 30, PaintedWorld::Road).map();
  const std::size_t before = heap();
  const Ground ground = groundOf(map);
  EXPECT_LT(heap() - before, 16u * 300 * 300);  // bytes, columns
}

TEST(Ground, ofALargeMapFollowsChangesHereAndThere) {
  PaintedWorld world;
  for (int x = -110; x < 110; x += 10)
    for (int y = -110; y < 110; y += 10) {
      world.floor(x, x + 2, y, y + 2, PaintedWorld::Road);
      world.floor(x + 3, x + 4, y, y + 1, PaintedWorld::Mud);  // a hole between
    }
  FollowingGround ground(world.map(), {}, {});
  for (int round = 0; round < 6; ++round) {
    const double x = -100 + 40 * round, y = round % 2 == 0 ? x : -x;
    world.floor(x - 4, x + 1, y - 4, y + 4, PaintedWorld::Mud);
    world.box(x, x + 0.3, y, y + 0.3, 0, 0.5, PaintedWorld::Wall).map({x + 0.05, y + 0.05, 3});
    EXPECT_FALSE(ground.update().empty());
    ground.expectReadAnew(600);
  }
}

TEST(Ground, squareBySquareIsThatOfTheWholeMap) {
  PaintedWorld world;
  world.floor(-12, 12, -12, 12, PaintedWorld::Road);
  addRubble(world, 3, 400);
  std::mt19937 random(3);
  for (int i = 0; i < 30; ++i) {  // holes to be filled, of all widths up to 4 m
    const double x = int(random() % 20) - 10, y = int(random() % 20) - 10, edge = 0.2 * (i % 20);
    world.box(x, x + edge, y, y + edge, 0.4, 0.6, PaintedWorld::Mud);
  }
  const SemanticOcTree& map = world.map({0.05, 0.05, 3});
  const Ground whole = groundOf(map, VehicleOptions(), {});
  for (int round = 0; round < 10; ++round) {
    std::vector<Column> tiles;
    for (const Column& tile : whole.tiles())
      if (random() % 3 == 0) tiles.push_back(tile);
    std::sort(tiles.begin(), tiles.end());
    GroundTiles part(map, {VehicleOptions(), {}, anyClass(), map.getResolution()});
    part.readSquares(tiles);
    std::size_t surfaces = 0;
    for (int x = -100; x < 100; ++x)
      for (int y = -100; y < 100; ++y) {
        const Column c{kOrigin + x, kOrigin + y};
        const SurfaceRange s = whole.surfaces(c), t = surfacesAt(part.surfaces(), c);
        surfaces += static_cast<std::size_t>(t.last - t.first);
        if (std::binary_search(tiles.begin(), tiles.end(), tileOf(c)))
          ASSERT_TRUE(std::equal(s.begin(), s.end(), t.begin(), t.end())) << x << ' ' << y;
        else
          ASSERT_TRUE(t.empty()) << x << ' ' << y;
      }
    EXPECT_GT(surfaces, 1000u);
  }
}

TEST(Ground, aHoleThatNoBeamEnteredIsFilledAfterAnUpdateAsInTheGroundReadAnew) {
  PaintedWorld world;
  FollowingGround following(world.map(), {}, {});
  world.floor(-3.2, 0, 0, 3.2, PaintedWorld::Road).map({-1.65, 1.65, 20});
  following.update();
  world.floor(3.2, 6.4, 0, 3.2, PaintedWorld::Road).map({4.85, 1.65, 20});
  following.update();
  following.expectReadAnew();
  const Ground& ground = following.ground;
  EXPECT_TRUE(ground.connected(*ground.find(-1, 1.6), *ground.find(5, 1.6)));
}

TEST(Ground, anUpdateTellsTheTilesThatChanged) {
  PaintedWorld world;
  world.floor(-20, 20, -20, 20, PaintedWorld::Road);
  FollowingGround following(world.map());
  EXPECT_TRUE(following.ground.update({}).empty());
  world.box(8.1, 8.3, 8.1, 8.3, 0, 1, PaintedWorld::Wall).map({8.05, 8.05, 10});
  const std::vector<Column> changed = following.update();
  const Column tile = tileOf(following.ground.columnAt(8.1, 8.1));
  EXPECT_NE(std::find(changed.begin(), changed.end(), tile), changed.end());
  EXPECT_LE(changed.size(), 4u);
}

TEST(Ground, followsAMapThatIsClearedAndOneThatBecomesAnother) {
  PaintedWorld world, other;
  addRubble(world, 2, 600);
  addRubble(other.floor(-6, 6, 2, 9, PaintedWorld::Road), 5, 300);
  SemanticOcTree& map = world.map();
  FollowingGround ground(map);
  const auto expectFollowed = [&ground] {
    EXPECT_FALSE(ground.update().empty());
    ground.expectReadAnew();
  };
  map.clear();
  expectFollowed();
  addRubble(world, 3, 600);
  world.map();
  expectFollowed();
  map = other.map();
  expectFollowed();
}
