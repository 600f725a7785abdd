#include <gtest/gtest.h>
#include <semantic_planning/ground/Ground.h>

#include "PaintedWorld.h"

using namespace semantic_planning;

namespace {

/** A floor with a slit from y = 0 to y = `width`. */
class SlitFloor : public testing::Test {
 protected:
  void paint(double width) {
    world.floor(-6, 6, -6, 0, PaintedWorld::Road);
    world.floor(-6, 6, width, 6, PaintedWorld::Grass);
  }

  Ground ground(double fillGap, double unknownGap,
                const colored_graph::ClassOrder& order = {5, {{1}, {2}, {3, 4}, {0}}}) {
    GroundOptions options;
    options.fillGap = fillGap;
    options.unknownGap = unknownGap;
    return Ground(world.map(), VehicleOptions(), options, order);
  }

  PaintedWorld world;
};

}  // namespace

TEST_F(SlitFloor, aNarrowSlitGetsTheClassOfItsNearerBorder) {
  paint(0.8);
  const Ground g = ground(1, 1);
  const auto nearRoad = g.find(0, 0.1), nearGrass = g.find(0, 0.7);
  ASSERT_TRUE(nearRoad && nearGrass);
  EXPECT_TRUE(nearRoad->surface.filled);
  EXPECT_EQ(nearRoad->surface.classId, PaintedWorld::Road);
  EXPECT_EQ(nearGrass->surface.classId, PaintedWorld::Grass);
  EXPECT_TRUE(g.connected(*g.find(0, -1), *g.find(0, 2)));
}

TEST_F(SlitFloor, aWiderSlitBetweenDifferentRanksIsUnknownGround) {
  paint(1.4);
  const auto middle = ground(1, 2).find(0, 0.7);
  ASSERT_TRUE(middle);
  EXPECT_TRUE(middle->surface.filled);
  EXPECT_EQ(middle->surface.classId, semantic_types::kNoClass);
}

TEST_F(SlitFloor, aWiderSlitBetweenEqualRanksHasTheClassOfItsNearerBorder) {
  paint(1.4);
  const Ground g = ground(1, 2, {5, {{0}, {1, 2, 3, 4}}});
  const auto nearRoad = g.find(0, 0.3), nearGrass = g.find(0, 1.1);
  ASSERT_TRUE(nearRoad && nearGrass);
  EXPECT_EQ(nearRoad->surface.classId, PaintedWorld::Road);
  EXPECT_EQ(nearGrass->surface.classId, PaintedWorld::Grass);
}

TEST_F(SlitFloor, aWiderSlitBetweenForbiddenClassesIsUnknownGround) {
  paint(1.4);
  const auto middle = ground(1, 2, {5, {{3, 4}, {0}}}).find(0, 0.7);
  ASSERT_TRUE(middle);
  EXPECT_EQ(middle->surface.classId, semantic_types::kNoClass);
}

TEST_F(SlitFloor, aSlitWiderThanAllGapsStaysOpen) {
  paint(2.4);
  const Ground g = ground(1, 2);
  EXPECT_FALSE(g.find(0, 1.2).has_value());
  EXPECT_FALSE(g.connected(*g.find(0, -1), *g.find(0, 4)));
}

TEST_F(SlitFloor, aWideFillLeavesNoFloorAboveANarrowOne) {
  paint(0.8);
  for (const double x : {-1.6, 1.2})  // their tops are joined along the slit, 0.4 m above its fill
    world.box(x, x + 0.4, 0, 0.8, 0, 0.4, PaintedWorld::Mud);
  const Ground g = ground(1, 3);
  const SurfaceRange surfaces = g.surfaces(g.columnAt(0, 0.3));
  ASSERT_EQ(surfaces.end() - surfaces.begin(), 1);
  EXPECT_TRUE(surfaces.begin()->filled);
  EXPECT_LT(g.centerOf(surfaces.begin()->z), 0);
  EXPECT_EQ(surfaces.begin()->clearance2, g.largestClearance() * g.largestClearance());
}

TEST_F(SlitFloor, whatStandsInTheSlitIsNotFilled) {
  paint(0.8);
  world.box(-6, 6, 0.4, 0.6, 0, 1, PaintedWorld::Wall);
  const Ground g = ground(1, 1);
  EXPECT_FALSE(g.connected(*g.find(0, -1), *g.find(0, 2)));
}

TEST_F(SlitFloor, aDitchIsNotFilled) {
  paint(0.8);
  world.box(-6, 6, 0, 0.8, -2, -1.8, PaintedWorld::Mud);  // seen from above: free space below
  const Ground g = ground(1, 1);
  EXPECT_FALSE(g.connected(*g.find(0, -1), *g.find(0, 2)));
}
