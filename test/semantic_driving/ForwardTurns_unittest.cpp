#include <gtest/gtest.h>
#include <semantic_driving/ForwardTurns.h>

#include <cmath>

#include "PaintedPlanner.h"

using namespace semantic_driving;
using namespace semantic_planning;

namespace {

constexpr double kLongest = 8;  // m backwards

/** Ahead along x from 0.1 to 3.1 m, and back to -3.9 m. */
DrivePath pathThereAndBack(PaintedWorld::Class ground = PaintedWorld::Grass) {
  std::vector<PathPoint> points;
  for (int i = 0; i <= 30; ++i) points.push_back({0.1 + 0.1 * i, 0.1, -0.1, 0, 0, true, ground, 0});
  for (int i = 1; i <= 70; ++i)
    points.push_back({3.1 - 0.1 * i, 0.1, -0.1, 0, 0, false, ground, 0});
  return DrivePath(points);
}

/** The path is over grass. */
class InPlaceOfBackingUp : public testing::Test {
 protected:
  InPlaceOfBackingUp() { world.floor(-12, 12, -8, 8, PaintedWorld::Grass); }
  std::optional<DrivePath> find(double from = 0, double worth = 0.5,
                                PaintedWorld::Class ground = PaintedWorld::Grass) {
    const SemanticPlanner planner = plannerOver(world);
    const DrivePath path = pathThereAndBack(ground);
    const auto found = ForwardTurns(planner, kLongest).find(path, from, worth);
    if (found) {
      const MotionCost price(planner.options().vehicle);
      EXPECT_LT(price.of(found->points()), price.of(path.points()) - worth);
    }
    return found;
  }
  PaintedWorld world;
};

}  // namespace

TEST_F(InPlaceOfBackingUp, GoesAheadToTheSamePose) {
  const auto found = find();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->stretchEnd(0), found->length());  // no change of gear
  EXPECT_TRUE(found->at(0).forward);
  const PathPoint begin = found->points().front(), end = found->points().back();
  EXPECT_NEAR(std::hypot(begin.x - 0.1, begin.y - 0.1), 0, 1e-6);
  EXPECT_NEAR(std::hypot(end.x + 3.9, end.y - 0.1, std::sin(end.heading)), 0, 1e-6);
  EXPECT_GT(std::cos(end.heading), 0);
}

TEST_F(InPlaceOfBackingUp, LeavesTheBeginningAsItIs) {
  const auto found = find(2);
  ASSERT_TRUE(found);
  for (double s = 0; s <= 2; s += 0.1) EXPECT_NEAR(found->at(s).y, 0.1, 1e-6) << s;
  EXPECT_NEAR(found->at(2).x, 2.1, 1e-6);
}

TEST_F(InPlaceOfBackingUp, ThereIsNothingWhereItCostsMore) { EXPECT_FALSE(find(0, 50)); }

TEST_F(InPlaceOfBackingUp, ThereIsNothingWhereItDoesNotFit) {
  world.box(-12, 12, 1, 1.2, 0, 1, PaintedWorld::Wall);
  world.box(-12, 12, -1, -0.8, 0, 1, PaintedWorld::Wall);
  EXPECT_FALSE(find());
}

TEST_F(InPlaceOfBackingUp, ThereIsNothingOverAWorseClass) {
  world.floor(-12, 12, -1, 1.2, PaintedWorld::Road);
  EXPECT_FALSE(find(0, 0.5, PaintedWorld::Road));
  world.floor(-12, 12, -8, 8, PaintedWorld::Road);
  EXPECT_TRUE(find(0, 0.5, PaintedWorld::Road));
}

TEST_F(InPlaceOfBackingUp, FarThereMayBeWhatThePathMeetsElsewhere) {
  world.floor(-12, 12, -1, 1.2, PaintedWorld::Road);
  std::vector<PathPoint> points = pathThereAndBack(PaintedWorld::Road).points();
  points.front().classId = PaintedWorld::Grass;
  const SemanticPlanner planner = plannerOver(world);
  EXPECT_FALSE(ForwardTurns(planner, 8).find(DrivePath(points), 0.5, 0.5));
  const auto found = ForwardTurns(planner, 6).find(DrivePath(points), 0.5, 0.5);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->longestBackwards(), 0);
  EXPECT_FALSE(ForwardTurns(planner, 6).find(pathThereAndBack(PaintedWorld::Road), 0.5, 0.5));
}

TEST_F(InPlaceOfBackingUp, APathWithoutChangesStays) {
  const SemanticPlanner planner = plannerOver(world);
  EXPECT_FALSE(ForwardTurns(planner, kLongest).find(pathThereAndBack().part(0, 3), 0, 0));
  EXPECT_FALSE(ForwardTurns(planner, kLongest).find({}, 0, 0));
}
