#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "PaintedGround.h"

using namespace painted_ground;
using semantic_octree::CellState;

namespace {

bool occupied(const SemanticOcTree& map, int x, int y, int z) {
  const octomap::OcTreeKey key(std::uint16_t(kOrigin + x), std::uint16_t(kOrigin + y),
                               std::uint16_t(kOrigin + z));
  return map.query(key).status == CellState::Status::Occupied;
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

TEST(Ground, knowsWhatIsOccupiedInAColumnBetweenTwoHeights) {
  PaintedWorld world;
  addRubble(world, 2, 800);
  const SemanticOcTree& map = world.map();
  const Ground ground = groundOf(map);
  const Ground part = ground.frozen();
  std::mt19937 random(3);
  int numOccupied = 0;
  for (int i = 0; i < 2000; ++i) {
    const int x = int(random() % 44) - 22, y = int(random() % 44) - 22, z = int(random() % 18) - 9;
    const int high = z + int(random() % 3);
    bool any = false;
    for (int k = z; k <= high; ++k) any = any || occupied(map, x, y, k);
    const Column c{kOrigin + x, kOrigin + y};
    ASSERT_EQ(ground.isOccupied(c, kOrigin + z, kOrigin + high), any) << x << ' ' << y << ' ' << z;
    if (i < 100) {
      EXPECT_EQ(part.isOccupied(c, kOrigin + z, kOrigin + high), any);
    }
    numOccupied += any;
  }
  EXPECT_GT(numOccupied, 50);
  EXPECT_FALSE(ground.isOccupied({kOrigin + 9000, kOrigin}, 0, 65535));
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
