#include <gtest/gtest.h>

#include "PaintedGround.h"

using namespace painted_ground;

namespace {

/** \param z of its frame, m */
std::optional<double> heightAt(double z, const Ground& ground) {
  FrameHeight height;
  height.look(ground, smallVehicle(), Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.1, z)));
  return height.meters();
}

/** Ground of 12 x 12 m but for what a robot in its middle does not see. */
PaintedWorld seenAround(double top = 0) {
  PaintedWorld world;
  const double low = top - 0.2, hole = 2;
  world.box(-6, 6, -6, -hole, low, top, PaintedWorld::Road);
  world.box(-6, 6, hole, 6, low, top, PaintedWorld::Grass);
  world.box(-6, -hole, -hole, hole, low, top, PaintedWorld::Road);
  world.box(hole, 6, -hole, hole, low, top, PaintedWorld::Road);
  return world;
}

}  // namespace

TEST(FrameHeight, isThatOfTheGroundAround) {
  PaintedWorld world = seenAround();
  const Ground ground = groundOf(world.map());
  for (const double z : {0.0, 0.3, 0.8, 1.73}) EXPECT_NEAR(heightAt(z, ground).value(), z, 0.11);
  EXPECT_EQ(heightAt(0, ground), 0) << "half a voxel is what the map is off";
}

TEST(FrameHeight, isNotKnownUntilGroundIsSeen) {
  PaintedWorld world;
  world.box(2, 4, 2, 4, 2, 3, PaintedWorld::Wall);  // above
  const Ground ground = groundOf(world.map());
  EXPECT_FALSE(heightAt(1, ground));
  EXPECT_FALSE(FrameHeight().meters());
  EXPECT_EQ(FrameHeight().onGround(Eigen::Isometry3d::Identity()).translation().z(), 0);
}

TEST(FrameHeight, isThatOfGroundAheadAloneForACamera) {
  PaintedWorld world;
  world.floor(1, 4, -2, 2, PaintedWorld::Road);
  EXPECT_NEAR(heightAt(1.2, groundOf(world.map())).value(), 1.2, 0.11);
}

TEST(FrameHeight, isThatAboveTheStoreyThatTheRobotIsOn) {
  PaintedWorld world = seenAround(3);
  world.floor(-6, 6, -6, 6, PaintedWorld::Road);
  const Ground ground = groundOf(world.map());
  EXPECT_NEAR(heightAt(3 + 1.73, ground).value(), 1.73, 0.11);
  EXPECT_NEAR(heightAt(1.73, ground).value(), 1.73, 0.11);
}

TEST(FrameHeight, isNotThatAboveTheGroundBesideAQuay) {
  for (const double z : {0.0, 1.73}) {
    PaintedWorld world;
    world.box(-6, 1, -6, 6, -0.2, 0, PaintedWorld::Road);
    world.box(1, 8, -6, 6, -3.2, -3, PaintedWorld::Mud);
    EXPECT_NEAR(heightAt(z, groundOf(world.map())).value(), z, 0.11);
  }
}

/** Roofs of cars on both sides are nearer than the road, but nothing to drive upon. */
TEST(FrameHeight, isNotThatAboveWhatTheOrderForbids) {
  PaintedWorld world = seenAround();
  for (const double y : {-2.6, 1.0}) world.box(-4, 4, y, y + 1.6, 1.2, 1.4, PaintedWorld::Wall);
  const Ground ground(world.map(), smallVehicle(), withoutGapFills(),
                      colored_graph::ClassOrder(5, {{PaintedWorld::Road, PaintedWorld::Grass}}));
  EXPECT_NEAR(heightAt(1.73, ground).value(), 1.73, 0.11);
}

/** One look that is wrong, as where little was seen yet, is outvoted. */
TEST(FrameHeight, isWhatMostPlacesTell) {
  PaintedWorld world = seenAround();
  const Ground right = groundOf(world.map());
  PaintedWorld lower = seenAround(-0.6);
  const Ground wrong = groundOf(lower.map());
  FrameHeight height;
  for (int i = 0; i < 5; ++i)
    height.look(i == 0 ? wrong : right, smallVehicle(),
                Eigen::Isometry3d(Eigen::Translation3d(0.1 + 0.3 * i, 0.1, 1)));
  EXPECT_NEAR(height.meters().value(), 1, 0.11);
}
