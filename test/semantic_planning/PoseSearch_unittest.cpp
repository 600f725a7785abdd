#include "planner/PoseSearch.h"

#include "PathFixture.h"

using namespace semantic_planning;

namespace {

/** A road of 3 m along y = 0 in the grass. It is wide enough to turn around in several moves, and
 * too narrow for one turn of 1 m with wheels on both sides. */
class PoseSearchTest : public PathTest {
 protected:
  static constexpr double kTolerance = 0.2, kHalfWidth = 1.5;

  PoseSearchTest() {
    world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
    world.floor(-15, 15, -kHalfWidth, kHalfWidth, PaintedWorld::Road);
  }

  /** Around to the left, over the grass, and back to the road. */
  std::vector<PathPoint> turnAtBegin() {
    return drive({0, 0, 0}, {{2, 0}, {M_PI, 1}, {1.2, 1}, {1.2, -1}, {11, 0}});
  }
  std::vector<PathPoint> turnAtEnd() {
    return drive({-11, 0.7, 0}, {{11, 0}, {1.2, 1}, {1.2, -1}, {M_PI, -1}, {2, 0}});
  }
  /** Meters with a wheel off the road, by geometry alone; a voxel's width is for nobody to tell. */
  double metersOnGrass(const std::vector<PathPoint>& path) {
    return meters(path, [&](const PathPoint& p) {
      const double aside = options.vehicle.wheelTrack / 2 * std::abs(std::cos(p.heading));
      return std::abs(p.y) + aside > kHalfWidth + world.map().getResolution();
    });
  }
};

}  // namespace

TEST_F(PoseSearchTest, whereAVehicleTurnsOverGrassAWayToTurnOnTheRoadIsFound) {
  for (const bool atBegin : {true, false}) {
    const auto before = atBegin ? turnAtBegin() : turnAtEnd();
    ASSERT_GT(metersOnGrass(before), 1.5);
    const auto after = (atBegin ? withBetterBegin : withBetterEnd)(before, checker(),
                                                                   ClassPrices(checker().order()));
    ASSERT_TRUE(after) << atBegin;
    PathChecker(world.map(), options.vehicle).expectDrivable(*after);
    expectSameEnds(*after, before);
    EXPECT_LE(metersOnGrass(*after), kTolerance);
    const auto& other = atBegin ? withBetterEnd : withBetterBegin;
    EXPECT_FALSE(other(before, checker(), ClassPrices(checker().order())))
        << "nothing is wrong at the other end";
  }
}

TEST_F(PoseSearchTest, whatHasNoMoreThanItMustIsLeftAsItIs) {
  const auto onRoad = drive({-12, 0, 0}, {{10, 0}, {0.5, 1}, {0.5, -1}, {8, 0}});
  EXPECT_FALSE(withBetterBegin(onRoad, checker(), ClassPrices(checker().order())));
  EXPECT_FALSE(withBetterEnd(onRoad, checker(), ClassPrices(checker().order())));
  const auto straightOffTheGrass = drive({0, -6, M_PI / 2}, {{5, 0}, {M_PI / 2, -1}, {8, 0}});
  EXPECT_FALSE(withBetterBegin(straightOffTheGrass, checker(), ClassPrices(checker().order())));
}

TEST_F(PoseSearchTest, aVehicleThatOnlyDrivesForwardIsGivenNoWayBackwards) {
  options.vehicle.reverseWeight = std::numeric_limits<double>::infinity();
  const auto detour = drive({0, 1, 0}, {{2 * M_PI, 1}, {12, 0}});  // a circle for nothing
  const auto after = withBetterBegin(detour, checker(), ClassPrices(checker().order()));
  ASSERT_TRUE(after);
  EXPECT_LE(metersOnGrass(*after), kTolerance);
  for (const auto& path :
       {*after, withBetterEnd(turnAtEnd(), checker(), ClassPrices(checker().order()))
                    .value_or(std::vector<PathPoint>())})
    for (const PathPoint& p : path) ASSERT_TRUE(p.forward);
}

TEST_F(PoseSearchTest, aWayIntoANarrowPlaceIsFoundFromWithin) {
  // A garage that is open in the west. In the east is a gap too narrow for the vehicle, but the
  // nearest way by its wheels. From there thousands of poses lead nowhere.
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  for (const double y : {-0.8, 0.6}) world.box(-7, -2, y, y + 0.2, 0, 1, PaintedWorld::Wall);
  for (const double y : {-0.8, 0.2}) world.box(-2, -1.8, y, y + 0.6, 0, 1, PaintedWorld::Wall);
  const TPose2D outside(8, 0, M_PI), inside(-3, 0, 0);
  for (const auto& [from, to] : {std::pair(outside, inside), std::pair(inside, outside)}) {
    const auto way = wayBetween(*checker().place(from), *checker().place(to), checker(),
                                ClassPrices(checker().order()));
    ASSERT_GE(way.size(), 2u) << from << to;
    PathChecker(world.map(), options.vehicle).expectDrivable(way);
    EXPECT_NEAR(way.front().x, from.x, 1e-6);
    EXPECT_NEAR(way.back().x, to.x, 1e-4);
    EXPECT_NEAR(std::remainder(way.back().heading - to.phi, 2 * M_PI), 0, 1e-4);
  }
}

TEST_F(PoseSearchTest, aGapThatTheVehicleIsTooWideForAttractsNobody) {
  // A wall with a gap ahead that its wheels alone would get through, and a gate far aside.
  options.vehicle.footprint = Footprint::rectangle(-1, 1, 2);
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  for (const auto& [from, to] :
       {std::pair(-15.0, -0.6), std::pair(0.6, 9.0), std::pair(13.0, 15.0)})
    world.box(0, 0.2, from, to, 0, 1, PaintedWorld::Wall);
  const auto way = wayBetween(*checker().place({-5, 0, 0}), *checker().place({5, 0, 0}), checker(),
                              ClassPrices(checker().order()));
  ASSERT_GE(way.size(), 2u);
  PathChecker(world.map(), options.vehicle).expectDrivable(way);
}
