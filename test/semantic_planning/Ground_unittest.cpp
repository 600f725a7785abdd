#include <gtest/gtest.h>
#include <semantic_octree/KeyframeMap.h>
#include <semantic_planning/ground/Ground.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "PaintedWorld.h"

using namespace semantic_planning;
using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kOrigin = semantic_octree::kKeyOfOrigin;

colored_graph::ClassOrder anyClass() { return {5, {{0, 1, 2, 3, 4}}}; }

/** A robot of 1 m in height that needs no clearance, and no gap fills. */
VehicleOptions smallVehicle() {
  VehicleOptions vehicle;
  vehicle.footprint = Footprint::rectangle(-0.1, 0.1, 0.2);
  vehicle.clearance = 0;
  vehicle.maxSlope = 80;
  return vehicle;
}

GroundOptions withoutGapFills() {
  GroundOptions options;
  options.fillGap = options.unknownGap = 0;
  return options;
}

Ground groundOf(const SemanticOcTree& map, const VehicleOptions& vehicle = smallVehicle(),
                const GroundOptions& options = withoutGapFills()) {
  return Ground(map, vehicle, options, anyClass());
}

void addRubble(PaintedWorld& world, unsigned seed, int voxels) {
  std::mt19937 random(seed);
  for (int i = 0; i < voxels; ++i)
    world.voxel(int(random() % 40) - 20, int(random() % 40) - 20, int(random() % 14) - 7,
                PaintedWorld::Class(1 + random() % 4));
}

bool occupied(const SemanticOcTree& map, int x, int y, int z) {
  const octomap::OcTreeKey key(std::uint16_t(kOrigin + x), std::uint16_t(kOrigin + y),
                               std::uint16_t(kOrigin + z));
  return map.query(key).status == CellState::Status::Occupied;
}

void expectSame(const Ground& a, const Ground& b) {
  for (int x = -60; x < 60; ++x)
    for (int y = -60; y < 60; ++y) {
      const Column c{kOrigin + x, kOrigin + y};
      const SurfaceRange s = a.surfaces(c), t = b.surfaces(c);
      ASSERT_TRUE(std::equal(s.begin(), s.end(), t.begin(), t.end())) << x << ' ' << y;
    }
}

}  // namespace

TEST(Ground, surfacesAreTheOccupiedVoxelsWithHeadRoomOfAColumnScan) {
  PaintedWorld world;
  addRubble(world, 1, 3000);
  const SemanticOcTree& map = world.map();
  const Ground ground = groundOf(map);
  std::size_t found = 0;
  for (int x = -22; x < 22; ++x)
    for (int y = -22; y < 22; ++y) {
      std::vector<std::pair<int, int>> expected;
      for (int z = -9; z < 9; ++z) {
        bool top = occupied(map, x, y, z);
        for (int above = 1; above <= 5; ++above) top = top && !occupied(map, x, y, z + above);
        const octomap::OcTreeKey key(std::uint16_t(kOrigin + x), std::uint16_t(kOrigin + y),
                                     std::uint16_t(kOrigin + z));
        if (top) expected.emplace_back(kOrigin + z, map.query(key).likeliestClass);
      }
      std::vector<std::pair<int, int>> surfaces;
      for (const Surface& s : ground.surfaces({kOrigin + x, kOrigin + y}))
        surfaces.emplace_back(s.z, s.classId);
      ASSERT_EQ(surfaces, expected) << x << ' ' << y;
      found += surfaces.size();
    }
  EXPECT_GT(found, 1000u);
}

TEST(Ground, afterUpdatesItIsTheGroundReadAnew) {
  PaintedWorld world;
  addRubble(world, 2, 600);
  world.floor(-6, 6, -6, 6, PaintedWorld::Road);
  SemanticOcTree& map = world.map();
  const GroundOptions filling;
  map.takeTouchedTiles();
  Ground ground = groundOf(map, VehicleOptions(), filling);
  for (unsigned round = 0; round < 8; ++round) {
    addRubble(world, 100 + round, 25);
    world.map({0.05 + 0.3 * round, 0.05, 20});
    ground.update(map.takeTouchedTiles());
    expectSame(ground, groundOf(map, VehicleOptions(), filling));
  }
}

TEST(Ground, withinSomeTilesIsThatOfTheWholeMap) {
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
    const Ground part(map, VehicleOptions(), {}, anyClass(), tiles);
    std::size_t surfaces = 0;
    for (int x = -100; x < 100; ++x)
      for (int y = -100; y < 100; ++y) {
        const Column c{kOrigin + x, kOrigin + y};
        const SurfaceRange s = whole.surfaces(c), t = part.surfaces(c);
        surfaces += static_cast<std::size_t>(t.last - t.first);
        if (std::binary_search(tiles.begin(), tiles.end(), tileOf(c)))
          ASSERT_TRUE(std::equal(s.begin(), s.end(), t.begin(), t.end())) << x << ' ' << y;
        else
          ASSERT_TRUE(t.empty()) << x << ' ' << y;
      }
    EXPECT_GT(surfaces, 1000u);
  }
}

TEST(Ground, withinSomeTilesDoesNotFollowChanges) {
  PaintedWorld world;
  world.floor(-2, 2, -2, 2, PaintedWorld::Road);
  SemanticOcTree& map = world.map();
  map.takeTouchedTiles();
  Ground ground(map, VehicleOptions(), {}, anyClass(),
                std::vector<Column>{tileOf({kOrigin, kOrigin})});
  EXPECT_TRUE(ground.update(map.takeTouchedTiles()).empty());
  world.voxel(0, 0, 0, PaintedWorld::Wall);
  world.map();
  EXPECT_THROW(ground.update(map.takeTouchedTiles()), std::logic_error);
}

TEST(Ground, followsKeyframesThatAreMovedAndRemoved) {
  PaintedWorld world;
  SemanticOcTree map(world.map().getResolution(), world.map().classes());
  const GroundOptions filling;
  semantic_octree::KeyframeMap keyframes(map);
  map.takeTouchedTiles();
  Ground ground = groundOf(map, VehicleOptions(), filling);
  std::mt19937 random(4);
  const auto slab = [&random](double height) {
    semantic_types::LabeledCloud cloud;
    for (double x = -4; x < 4; x += 0.1)
      for (double y = -4; y < 4; y += 0.1) {
        cloud.points.emplace_back(x, y, height + (random() % 9 == 0 ? 0.4 : 0));
        cloud.classes.push_back(PaintedWorld::Road);
      }
    return cloud;
  };
  const auto expectFollowed = [&] {
    ground.update(map.takeTouchedTiles());
    expectSame(ground, groundOf(map, VehicleOptions(), filling));
  };
  const Eigen::Isometry3d above(Eigen::Translation3d(0.05, 0.05, 2));
  for (int i = 0; i < 3; ++i) {
    keyframes.begin(Eigen::Isometry3d(Eigen::Translation3d(3 * i, 0, 0.3 * i)));
    keyframes.insert(slab(-2), above);
    expectFollowed();
  }
  keyframes.move({{1, Eigen::Isometry3d(Eigen::Translation3d(3, 0, 0))},
                  {2, Eigen::Isometry3d(Eigen::Translation3d(6, 0, 0))}});
  expectFollowed();
  keyframes.remove(0);
  expectFollowed();
}

TEST(Ground, aHoleThatNoBeamEnteredIsFilledAfterAnUpdateAsInTheGroundReadAnew) {
  PaintedWorld world;
  const GroundOptions filling;
  SemanticOcTree& map = world.map();
  map.takeTouchedTiles();
  Ground ground = groundOf(map, VehicleOptions(), filling);
  world.floor(-3.2, 0, 0, 3.2, PaintedWorld::Road).map({-1.65, 1.65, 20});
  ground.update(map.takeTouchedTiles());
  world.floor(3.2, 6.4, 0, 3.2, PaintedWorld::Road).map({4.85, 1.65, 20});
  ground.update(map.takeTouchedTiles());
  expectSame(ground, groundOf(map, VehicleOptions(), filling));
  EXPECT_TRUE(ground.connected(*ground.find(-1, 1.6), *ground.find(5, 1.6)));
}

TEST(Ground, aSurfaceHasTheLikeliestClassOfItsVoxel) {
  PaintedWorld world;
  std::mt19937 random(6);
  for (int scan = 0; scan < 6; ++scan) {
    for (int x = 0; x < 16; ++x)
      for (int y = 0; y < 16; ++y) world.voxel(x, y, -1, PaintedWorld::Class(1 + random() % 4));
    world.map();
  }
  const Ground ground = groundOf(world.map());
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y) {
      const octomap::OcTreeKey key(std::uint16_t(kOrigin + x), std::uint16_t(kOrigin + y),
                                   std::uint16_t(kOrigin - 1));
      const Surface* s = ground.near({key[0], key[1]}, key[2], 0);
      ASSERT_NE(s, nullptr);
      EXPECT_EQ(s->classId, world.map().query(key).likeliestClass) << x << ' ' << y;
    }
}

TEST(Ground, anUpdateTellsTheTilesThatChanged) {
  PaintedWorld world;
  world.floor(-20, 20, -20, 20, PaintedWorld::Road);
  SemanticOcTree& map = world.map();
  map.takeTouchedTiles();
  Ground ground = groundOf(map);
  EXPECT_TRUE(ground.update({}).empty());
  world.box(8.1, 8.3, 8.1, 8.3, 0, 1, PaintedWorld::Wall).map({8.05, 8.05, 10});
  const std::vector<Column> changed = ground.update(map.takeTouchedTiles());
  const Column tile = tileOf(ground.columnAt(8.1, 8.1));
  EXPECT_NE(std::find(changed.begin(), changed.end(), tile), changed.end());
  EXPECT_LE(changed.size(), 4u);
}

TEST(Ground, clearanceIsTheDistanceToTheNearestColumnWithoutFreeGround) {
  PaintedWorld world;
  std::mt19937 random(5);
  std::vector<std::vector<bool>> free(40, std::vector<bool>(40, true));
  for (int i = 0; i < 40; ++i) free[random() % 40][random() % 40] = false;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y)
      if (free[x][y] || (x + y) % 2) {  // what is not free is a hole or a pillar
        world.voxel(x, y, -1, PaintedWorld::Road);
        for (int z = 0; z < 8 && !free[x][y]; ++z) world.voxel(x, y, z, PaintedWorld::Wall);
      }
  VehicleOptions vehicle = smallVehicle();
  vehicle.clearance = 0.8;
  const Ground ground = groundOf(world.map(), vehicle);
  const int farthest = ground.largestClearance();
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) {
      if (!free[x][y]) continue;
      int nearest = farthest * farthest;
      for (int u = -1; u <= 40; ++u)
        for (int v = -1; v <= 40; ++v) {
          const bool outside = u < 0 || v < 0 || u >= 40 || v >= 40;
          const int dx = std::max(0, std::abs(u - x) - 1), dy = std::max(0, std::abs(v - y) - 1);
          if (outside || !free[u][v]) nearest = std::min(nearest, dx * dx + dy * dy);
        }
      const Surface* s = ground.near({kOrigin + x, kOrigin + y}, kOrigin - 1, 0);
      ASSERT_NE(s, nullptr);
      EXPECT_EQ(s->clearance2, nearest) << x << ' ' << y;
    }
}

TEST(Ground, steepGroundIsNotDrivable) {
  const auto drivable = [](double slope, double limit) {
    PaintedWorld world(0.1);
    for (double x = 0; x < 6; x += 0.1) {
      const double z = std::floor(x * std::tan(slope * M_PI / 180) / 0.1) * 0.1;
      world.box(x, x + 0.1, -2, 2, z, z + 0.1, PaintedWorld::Road);
    }
    VehicleOptions vehicle = smallVehicle();
    vehicle.maxSlope = limit;
    const Ground ground = groundOf(world.map({3.05, 0.05, 20}), vehicle);
    return ground.find(3.05, 0.05).has_value();
  };
  EXPECT_TRUE(drivable(15, 20));
  EXPECT_FALSE(drivable(35, 20));
  EXPECT_TRUE(drivable(35, 45));
}

TEST(Ground, aBridgeAndTheRoadBelowAreTwoLevels) {
  PaintedWorld world;
  world.floor(-10, 10, -2, 2, PaintedWorld::Road);
  world.box(-1, 1, -6, 6, 3, 3.2, PaintedWorld::Grass);
  // The scan from above does not see below the bridge: another one from the side does.
  const Ground ground = groundOf(world.map({-9, 0.05, 2}));
  const auto low = ground.find(0.1, 0.1), high = ground.find(0.1, 0.1, 3.0);
  ASSERT_TRUE(low && high);
  EXPECT_EQ(low->surface.classId, PaintedWorld::Road);
  EXPECT_EQ(high->surface.classId, PaintedWorld::Grass);
  EXPECT_FALSE(ground.connected(*low, *high));
  EXPECT_TRUE(ground.connected(*low, *ground.find(-8, 1)));
  EXPECT_TRUE(ground.connected(*high, *ground.find(0.1, 5, 3.0)));
}

TEST(Ground, stepsConnectUpToTheStepHeight) {
  const auto connected = [](double stepHeight) {
    PaintedWorld world(0.1);
    world.box(-2, 0, -1, 1, -0.1, 0, PaintedWorld::Road);
    world.box(0, 2, -1, 1, -0.1, 0.3, PaintedWorld::Road);
    VehicleOptions vehicle = smallVehicle();
    vehicle.stepHeight = stepHeight;
    const Ground ground = groundOf(world.map(), vehicle);
    return ground.connected(*ground.find(-1, 0), *ground.find(1, 0));
  };
  EXPECT_TRUE(connected(0.3));
  EXPECT_FALSE(connected(0.2));
}

TEST(Ground, refusesAnOrderOfOtherClasses) {
  PaintedWorld world;
  EXPECT_THROW(Ground(world.map(), VehicleOptions(), GroundOptions(), {3, {{0, 1, 2}}}),
               std::invalid_argument);
}

TEST(Ground, ofAnEmptyMapThereIsNone) {
  PaintedWorld world;
  const Ground ground = groundOf(world.map());
  EXPECT_TRUE(ground.tiles().empty());
  EXPECT_FALSE(ground.find(0, 0).has_value());
}
