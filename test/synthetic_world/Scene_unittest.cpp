#include <gtest/gtest.h>
#include <semantic_types/ClassTable.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include <set>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;

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

TEST_P(EveryScene, driveIsSmoothAndOnTheGround) {
  const Drive drive(scene, 1.5);
  EXPECT_NEAR(drive.duration() * 1.5, scene.route.length(), 1e-9);
  Eigen::Isometry3d before = drive.T_world_robot(-0.1);
  for (double t = 0; t < drive.duration(); t += 0.1) {
    const Eigen::Isometry3d now = drive.T_world_robot(t), moved = before.inverse() * now;
    EXPECT_NEAR(now.translation().z(),
                scene.world.groundHeight(now.translation().x(), now.translation().y()), 1e-12);
    EXPECT_NEAR(moved.translation().norm(), 0.15, 0.01) << t;
    EXPECT_LT(Eigen::AngleAxisd(moved.linear()).angle(), 0.06) << t;
    before = now;
  }
}

TEST_P(EveryScene, showsManyClassesFromAbove) {
  const TopView view = renderTopView(scene.world, 0.5);
  const std::set<ClassId> seen(view.labels.pixels.begin(), view.labels.pixels.end());
  EXPECT_EQ(seen.count(kNoClass), 0u);
  EXPECT_GE(seen.size(), 11u);
  for (const ClassId id : {kRoad, kGrass, kWater, kCanopy, kRoof, kCar, kFlowerBed})
    EXPECT_EQ(seen.count(id), 1u) << classTable().name(id);
}

TEST(Scene, hillsScaleTheGround) {
  EXPECT_EQ(makeScene("park", 1, 0).world.terrain().highest(), 0);
  EXPECT_EQ(makeScene("park", 1, 0).world.terrain().lowest(), 0);
  EXPECT_GT(makeScene("park", 1, 1).world.terrain().highest(), 2);
  EXPECT_DOUBLE_EQ(makeScene("park", 1, 2).world.groundHeight(3, 4),
                   2 * makeScene("park", 1, 1).world.groundHeight(3, 4));
}

TEST(Scene, badNamesAndHillsAreRefused) {
  EXPECT_EQ(errorOf([] { makeScene("moon", 1); }),
            "scene: no scene 'moon'; there are: village, park, campus");
  EXPECT_EQ(errorOf([] { makeScene("park", 1, 3); }), "scene: hills is 3.000000, 0 to 2 expected");
}

TEST(Scene, driveRefusesToStandStill) {
  const Scene scene = makeScene("park", 1);
  EXPECT_THROW(Drive(scene, 0), std::invalid_argument);
}

TEST(Scene, walkerGoesToAndFro) {
  const World world = small_world::flat();
  const Walker walker{{0, 0}, {6, 0}, 1.5};
  const auto isAt = [&](double time, double x) {
    World now = small_world::flat();
    now.setMovables(walker.at(world, time));
    return now.at({x, 0, 1.2}).id == kPerson;
  };
  EXPECT_TRUE(isAt(0, 0));
  EXPECT_TRUE(isAt(2, 3));
  EXPECT_TRUE(isAt(4, 6));
  EXPECT_TRUE(isAt(6, 3));
  EXPECT_FALSE(isAt(6, 0));
  EXPECT_TRUE(isAt(8, 0));
}

TEST(Scene, classTableIsThatOfTheConfiguration) {
  EXPECT_EQ(classTable(), semantic_types::loadClassTable(std::string(MSO_SOURCE_DIR) +
                                                         "/config/classes/synthetic.yaml"));
  EXPECT_EQ(classTable().size(), kClassCount);
  EXPECT_EQ(classTable().name(kPerson), "person");
  EXPECT_EQ(classTable().name(kFlowerBed), "flower-bed");
}

TEST(Scene, colorsOfClassesCanBeToldApart) {
  const ClassTable& table = classTable();
  for (ClassId a = 1; a <= table.size(); ++a)
    for (ClassId b = 1; b < a; ++b) {
      const Color p = table.color(a), q = table.color(b);
      const Eigen::Vector3d difference(p.r - q.r, p.g - q.g, p.b - q.b);
      EXPECT_GT(difference.norm(), 40) << table.name(a) << ' ' << table.name(b);
    }
}

}  // namespace
