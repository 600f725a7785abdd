#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/World.h>
#include <Eigen/Geometry>

#include <cmath>
#include <set>

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

using V2 = Eigen::Vector2d;

TEST(GroundCover, laterStrokesCoverEarlierOnes) {
  GroundCover cover(20, kGrass);
  cover.paintDisk(kGravel, {1, -3}, 4);
  cover.paintStroke(kRoad, {-15, -3}, {15, -3}, 2);
  cover.paintBand(kLaneMarking, {-1, -3}, {1, -3}, 0.2);
  EXPECT_EQ(cover.at(1, 3), kGrass);
  EXPECT_EQ(cover.at(1, -0.5), kGravel);
  EXPECT_EQ(cover.at(5, -3), kRoad);
  EXPECT_EQ(cover.at(0.9, -2.95), kLaneMarking);
  EXPECT_EQ(cover.at(1.05, -3), kRoad);  // a band has square ends
  EXPECT_EQ(cover.at(-1.05, -3), kRoad);
  EXPECT_EQ(cover.at(-16.9, -3), kRoad);  // a stroke has round ones
  EXPECT_EQ(cover.at(-16.9, -2), kGrass);
}

TEST(GroundCover, stripAroundACurveIsWhatLiesWithinItsHalfWidth) {
  const Curve curve({{-15, -9}, {0, -12}, {10, 4}, {-8, 13}}, 5);
  GroundCover cover(20, kGrass);
  cover.paintCurve(kRoad, curve, 2);
  Random random(3);
  int onRoad = 0;
  for (int i = 0; i < 3000; ++i) {
    const V2 p(random.uniform(-20, 20), random.uniform(-20, 20));
    double far = 1e9;
    for (double s = 0; s <= curve.length(); s += 0.02)
      far = std::min(far, (curve.at(s) - p).norm());
    if (std::abs(far - 2) < 0.08) continue;  // the strip is made of straight pieces
    EXPECT_EQ(cover.at(p), far < 2 ? kRoad : kGrass) << p.transpose();
    onRoad += far < 2;
  }
  EXPECT_GT(onRoad, 200);
}

using synthetic_world::Random;
using synthetic_world::Terrain;

const std::vector<Terrain::Wave> kHills{{2, 40, 0.3, 1}, {0.7, 15, 2.0, 0.2}};

TEST(Terrain, followsItsWaves) {
  const Terrain terrain(40, kHills);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-40, 40), y = random.uniform(-40, 40);
    double expected = 0;
    for (const auto& w : kHills)
      expected +=
          w.amplitude *
          std::sin(2 * M_PI / w.length * (x * std::cos(w.direction) + y * std::sin(w.direction)) +
                   w.phase);
    EXPECT_NEAR(terrain.height(x, y), expected, 0.05);
  }
}

TEST(Terrain, beyondTheEdgeTheEdgesHeightGoesOn) {
  const Terrain terrain(40, kHills);
  EXPECT_EQ(terrain.height(95, 7), terrain.height(40, 7));
  EXPECT_EQ(terrain.height(3, -41), terrain.height(3, -40));
}

class EveryScene : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  Scene scene = makeScene(std::get<0>(GetParam()), std::get<1>(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene,
                         testing::Combine(testing::ValuesIn(sceneNames()), testing::Range(1, 6)),
                         [](const auto& tested) {
                           return std::get<0>(tested.param) +
                                  std::to_string(std::get<1>(tested.param));
                         });

TEST_P(EveryScene, routeStaysOnTheRoadAndClearOfEverything) {
  const Footprint robot;
  for (double s = 0; s < scene.route.length(); s += 0.25) {
    const Eigen::Vector2d at = scene.route.at(s);
    const ClassId id = scene.world.groundClass(at.x(), at.y());
    EXPECT_TRUE(id == kRoad || id == kLaneMarking || id == kGravel) << classTable().name(id);
    EXPECT_GT(scene.world.clearance(robot, at.x(), at.y(), scene.route.heading(s)), 0.3) << s;
  }
}

TEST_P(EveryScene, wayAlongTheRouteIsSmoothAndOnTheGround) {
  constexpr double kStep = 0.15;  // m
  Eigen::Isometry3d before = scene.T_world_robot(-kStep);
  for (double s = 0; s < scene.route.length(); s += kStep) {
    const Eigen::Isometry3d now = scene.T_world_robot(s), moved = before.inverse() * now;
    EXPECT_NEAR(now.translation().z(),
                scene.world.groundHeight(now.translation().x(), now.translation().y()), 1e-12);
    EXPECT_NEAR(moved.translation().norm(), kStep, 0.01) << s;
    EXPECT_LT(Eigen::AngleAxisd(moved.linear()).angle(), 0.06) << s;
    before = now;
  }
}

TEST_P(EveryScene, showsManyClassesFromAbove) {
  constexpr double kHeight = 60;
  const double end = scene.world.halfExtent();
  std::set<ClassId> seen;
  for (double x = 0.25 - end; x < end; x += 0.5)
    for (double y = 0.25 - end; y < end; y += 0.5) {
      const auto hit = scene.world.castRay({x, y, scene.world.groundHeight(x, y) + kHeight},
                                           -Eigen::Vector3d::UnitZ(), 2 * kHeight);
      seen.insert(hit ? hit->material.id : kNoClass);
    }
  EXPECT_EQ(seen.count(kNoClass), 0u);
  EXPECT_GE(seen.size(), 11u);
  for (const ClassId id : {kRoad, kGrass, kWater, kCanopy, kRoof, kCar, kFlowerBed})
    EXPECT_EQ(seen.count(id), 1u) << classTable().name(id);
}

TEST(Scene, hillsScaleTheGround) {
  EXPECT_EQ(makeScene("park", 1, 0).world.terrain().highest(), 0);
  EXPECT_GT(makeScene("park", 1, 1).world.terrain().highest(), 2);
  EXPECT_DOUBLE_EQ(makeScene("park", 1, 2).world.groundHeight(3, 4),
                   2 * makeScene("park", 1, 1).world.groundHeight(3, 4));
}

TEST(Scene, badNamesAndHillsAreRefused) {
  EXPECT_EQ(errorOf([] { makeScene("moon", 1); }),
            "scene: no scene 'moon'; there are: village, park, campus");
  EXPECT_EQ(errorOf([] { makeScene("park", 1, 3); }), "scene: hills is 3.000000, 0 to 2 expected");
}

TEST(Scene, classTableIsThatOfTheConfiguration) {
  EXPECT_EQ(classTable(), semantic_types::loadClassTable(std::string(MSO_SOURCE_DIR) +
                                                         "/config/classes/synthetic.yaml"));
  EXPECT_EQ(classTable().size(), kClassCount);
  EXPECT_EQ(classTable().name(kPerson), "person");
  EXPECT_EQ(classTable().name(kFlowerBed), "flower-bed");
}

}  // namespace
