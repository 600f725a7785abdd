#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using State = PointTruth::State;
using V = Eigen::Vector3d;

TEST(World, truthKnowsFreeSpaceSurfacesAndWhatIsBehindThem) {
  const World world = small_world::withWall();
  EXPECT_EQ(world.at({0, 0, 1}), (PointTruth{State::Free, kNoClass}));
  EXPECT_EQ(world.at({0, 0, 0.005}), (PointTruth{State::Surface, kGrass}));
  EXPECT_EQ(world.at({0, 0, -0.005}), (PointTruth{State::Surface, kGrass}));
  EXPECT_EQ(world.at({0, 0, -0.5}), (PointTruth{State::Underground, kGrass}));
  EXPECT_EQ(world.at({4.995, 0, 3}), (PointTruth{State::Surface, kWall}));
  EXPECT_EQ(world.at({5.3, 0, 3}), (PointTruth{State::Inside, kWall}));
  EXPECT_EQ(world.at({5.5, 0, 7.9}), (PointTruth{State::Inside, kRoof}));
  EXPECT_EQ(world.at({4.98, 0, 3}), (PointTruth{State::Free, kNoClass}));
  EXPECT_EQ(world.at({4.98, 0, 3}, 0.05), (PointTruth{State::Surface, kWall}));
  EXPECT_EQ(world.at({99, 0, -1}), (PointTruth{State::Free, kNoClass}));  // not of this world
  EXPECT_THROW(world.at({0, 0, 0}, -1), std::invalid_argument);
}

TEST(World, surfacesHiddenInASolidAreInside) {
  const World world = small_world::flat(
      {{Spheroid{{0, 0, 4}, 2, 2}, kCanopy}, {Shaft{{0, 0}, 0.3, 0.3, 0, 5}, kTrunk}});
  EXPECT_EQ(world.at({0.3, 0, 1}), (PointTruth{State::Surface, kTrunk}));
  EXPECT_EQ(world.at({0.3, 0, 4}), (PointTruth{State::Inside, kCanopy}));
}

TEST(World, movablesAreTrue) {
  World world = small_world::flat();
  world.setMovables(person({1, 2, 0}, 0, {200, 0, 0}));
  EXPECT_EQ(world.at({1, 2, 1.2}).id, kPerson);
  EXPECT_EQ(world.at({1, 2, 1.2}).state, State::Inside);
  EXPECT_FALSE(world.isFree(Footprint(), 1.3, 2, 0));
  EXPECT_TRUE(world.isFree(Footprint(), 2.3, 2, 0));
}

TEST(World, windowsArePartOfTheTruth) {
  Random random(1);
  const World world = small_world::flat(house({0, 0, 0}, 0, {10, 8}, 2, random));
  int windows = 0, walls = 0;
  for (double x = -4.9; x < 5; x += 0.1)
    for (double z = 0.1; z < 5.8; z += 0.1) {
      const ClassId id = world.at({x, -4, z}).id;
      ASSERT_TRUE(id == kWindow || id == kBuilding || id == kGrass || id == kRoof) << +id;
      windows += id == kWindow, walls += id == kBuilding;
    }
  EXPECT_NEAR(windows, 2 * 4 * 12 * 13, 300);  // two storeys of four windows, 1.2 x 1.3 m
  EXPECT_GT(walls, windows);
}

TEST(World, robotsStandOnTheGroundWithTheSlopeUnderThem) {
  const Scene scene = makeScene("park", 3);
  const World& world = scene.world;
  for (double s = 0; s < scene.route.length(); s += 7) {
    const Eigen::Vector2d at = scene.route.at(s);
    const double yaw = scene.route.heading(s);
    const Eigen::Isometry3d T = world.poseOnGround(at.x(), at.y(), yaw);
    EXPECT_NEAR((T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm(), 0,
                1e-12);
    EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
    EXPECT_NEAR(std::remainder(std::atan2(T(1, 0), T(0, 0)) - yaw, 2 * M_PI), 0, 1e-12);
    EXPECT_EQ(T.translation().z(), world.groundHeight(at.x(), at.y()));
    for (const V& wheel : {V(0.3, 0.2, 0), V(-0.3, -0.2, 0)}) {
      const V p = T * wheel;
      EXPECT_NEAR(p.z(), world.groundHeight(p.x(), p.y()), 0.03);
    }
  }
}

TEST(World, clearanceIsTheDistanceToTheNearestSolid) {
  const World world = small_world::flat({small_world::box({5, 0}, {2, 2}, 0, 3, kWall, kWall),
                                         {Shaft{{0, 4}, 0.5, 0.5, -1, 2}, kTrunk}});
  Footprint robot;
  robot.outline = rectangle({0, 0}, 0, 2, 1);
  EXPECT_NEAR(world.clearance(robot, 0, 0, 0), 3, 1e-12);           // nose to the box
  EXPECT_NEAR(world.clearance(robot, 0, 0, M_PI / 2), 2.5, 1e-12);  // nose to the trunk
  EXPECT_EQ(world.clearance(robot, -20, -20, 0), 5);                // the limit
  EXPECT_EQ(world.clearance(robot, 3.1, 0, 0), 0);
  EXPECT_FALSE(world.isFree(robot, 3.1, 0, 0));
  EXPECT_TRUE(world.isFree(robot, 2.9, 0, 0));
}

TEST(World, whatIsAboveOrBelowTheRobotIsNoObstacle) {
  const World world = small_world::flat({small_world::box({0, 0}, {2, 2}, 1.5, 3, kRoof, kRoof),
                                         small_world::box({9, 0}, {2, 2}, -1, 0.08, kRock, kRock)});
  Footprint robot;
  EXPECT_TRUE(world.isFree(robot, 0, 0, 0));
  EXPECT_TRUE(world.isFree(robot, 9, 0, 0));
  robot.height = 1.6;
  EXPECT_FALSE(world.isFree(robot, 0, 0, 0));
  robot.clearance = 0.05;
  EXPECT_FALSE(world.isFree(robot, 9, 0, 0));
}

TEST(World, clearanceAgreesWithPointsOfSolidsInEveryScene) {
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 2);
    const World& world = scene.world;
    const Footprint robot;
    Random random(31);
    int collisions = 0;
    for (int i = 0; i < 1500; ++i) {
      const double x = random.uniform(-45, 45), y = random.uniform(-45, 45);
      const double yaw = random.uniform(-M_PI, M_PI), ground = world.groundHeight(x, y);
      const V p(x + 0.4 * std::cos(yaw), y + 0.4 * std::sin(yaw),
                ground + random.uniform(0.15, 1.15));
      if (world.at(p).state != State::Inside) continue;
      EXPECT_EQ(world.clearance(robot, x, y, yaw), 0) << name << ' ' << p.transpose();
      ++collisions;
    }
    EXPECT_GT(collisions, 5) << name;
  }
}

TEST(World, footprintsNameTheirBadField) {
  Footprint robot;
  robot.height = 0.05;
  EXPECT_EQ(errorOf([&] { robot.validate(); }),
            "footprint: height is 0.050000, more than clearance expected");
  robot = {};
  robot.clearance = -1;
  EXPECT_EQ(errorOf([&] { robot.validate(); }),
            "footprint: clearance is -1.000000, 0 m or more expected");
  robot = {};
  robot.outline.pop_back(), robot.outline.pop_back();
  EXPECT_EQ(errorOf([&] { robot.validate(); }),
            "footprint: outline: three or more corners, convex, counterclockwise expected");
}

}  // namespace
