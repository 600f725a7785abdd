#include <gtest/gtest.h>

#include <cmath>

#include "PaintedPlanner.h"
#include "Recovery.h"

using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

/** A road for x > 0, and mud, which is forbidden, for x < 0. */
class Recovery : public testing::Test {
 protected:
  Recovery() {
    world.floor(0, 12, -10, 10, PaintedWorld::Road);
    world.floor(-12, 0, -10, 10, PaintedWorld::Mud);
  }
  SemanticPlanner planner() { return plannerOver(world); }
  /** Meters of a path whose middle is over mud. */
  static double overMud(const DrivePath& path) {
    double length = 0;
    constexpr double kStep = 0.01;
    for (double s = 0; s < path.length(); s += kStep) length += path.at(s).x < 0 ? kStep : 0;
    return length;
  }

  PaintedWorld world;
};

}  // namespace

TEST_F(Recovery, LeavesForbiddenGroundTheShortestWay) {
  const SemanticPlanner planner = this->planner();
  for (const double heading : {0.0, M_PI}) {
    const TPose2D from(-1.5, 0, heading);
    ASSERT_NE(planner.check(from, 0), PlanStatus::Found);
    const DrivePath path = findRecovery(planner, from, 0);
    ASSERT_FALSE(path.empty());
    EXPECT_EQ(path.points().front().forward, heading == 0);  // it backs out where that is shorter
    EXPECT_NEAR(overMud(path), 1.5, 0.2);                    // straight to the border
    const PathPoint end = path.points().back();
    EXPECT_EQ(planner.check(poseOf(end), end.z), PlanStatus::Found);
  }
}

TEST_F(Recovery, KeepsTheFootprintFree) {
  world.box(-0.4, -0.2, -1, 1, 0, 1, PaintedWorld::Wall);  // between the vehicle and the road
  const SemanticPlanner planner = this->planner();
  const DrivePath path = findRecovery(planner, {-2, 0, 0}, 0);
  ASSERT_FALSE(path.empty());
  for (const PathPoint& p : path.points())
    EXPECT_FALSE(p.x > -0.4 - 0.25 && p.x < -0.2 + 0.25 && std::abs(p.y) < 1) << p.x << ' ' << p.y;
}

TEST_F(Recovery, GetsAwayFromAWallThatIsTooClose) {
  world.box(5, 5.2, -3, 3, 0, 1, PaintedWorld::Wall);
  const SemanticPlanner planner = plannerOver(world, 0.4);
  const TPose2D from(5 - 0.55 - 0.25, 0.1, 0);
  ASSERT_NE(planner.check(from, 0), PlanStatus::Found);
  const DrivePath path = findRecovery(planner, from, 0);
  ASSERT_FALSE(path.empty());
  EXPECT_FALSE(path.points().front().forward);
  EXPECT_LT(path.length(), 1);
}

TEST_F(Recovery, OfABlindVehicleLeadsAsFarAsItIsBlind) {
  const SemanticPlanner planner = this->planner();
  const TPose2D from(4, 0, 0);
  const DrivePath path = findRecovery(planner, from, 0, 2);
  ASSERT_FALSE(path.empty());
  const PathPoint end = path.points().back();
  EXPECT_GT(std::hypot(end.x - from.x, end.y - from.y), 2);
}

TEST_F(Recovery, ThereIsNoneBeyondEightMeters) {
  const SemanticPlanner planner = this->planner();
  EXPECT_TRUE(findRecovery(planner, {-9, 0, 0}, 0).empty());
  EXPECT_FALSE(findRecovery(planner, {-6, 0, 0}, 0).empty());
}
