// Drives to goals that cannot be reached, or only seem so.
#include <gtest/gtest.h>
#include <semantic_driving/PathCheck.h>
#include <synthetic_world/Objects.h>

#include <cmath>

#include "PaintedPlanner.h"
#include "PlainDrives.h"
#include "TemporaryFolder.h"

using namespace plain_drives;

TEST(Drives, StopAndSaySoWhereNoWayLeads) {
  synthetic_world::Solids solids;
  addWall(solids, {-12, -4}, {0, -4});  // the robot is within, the goal is not
  addWall(solids, {0, -4}, {0, 4});
  addWall(solids, {0, 4}, {-12, 4});
  addWall(solids, {-12, 4}, {-12, -4});
  World world = plain(solids);
  const DriveRecord record = drive(world, {-8, 0, 0}, {8, 0, 0});
  EXPECT_EQ(record.end, DriveEnd::Unreachable);
  EXPECT_EQ(record.reason, "the vehicle is enclosed by what it cannot pass");
  EXPECT_EQ(record.collisions, 0);
  EXPECT_LT(std::abs(record.rows.back().speed), 0.06);
}

TEST(Drives, SayAtOnceThatAGoalDoesNotFitAndWhichPoseDoes) {
  synthetic_world::Solids solids;
  addWall(solids, {4, -6}, {4, 6});
  World world = plain(solids);
  const TPose2D goal(3.6, 0, 0);  // its front is in the wall
  const DriveRecord told = drive(world, {-4, 0, 0}, goal);
  EXPECT_EQ(told.end, DriveEnd::Unreachable);
  ASSERT_TRUE(told.refusal);
  EXPECT_LT(told.refusal->seconds, 15);  // it saw the wall at the beginning
  EXPECT_EQ(told.refusal->reason.find("the goal (3.60, 0.00) does not fit: wall is at ("), 0u)
      << told.refusal->reason;
  EXPECT_TRUE(contains(told.reason, "; the nearest pose known to fit: "));
  DriveConfig config = smallConfig();  // at rest a step after its last row
  EXPECT_LT(std::abs(told.rows.back().speed),
            semantic_driving::DriveOptions::kAtRest +
                config.drive.maxAcceleration * config.controlPeriod);

  config.guide.driveToNearest = true;
  const DriveRecord driven = drive(world, {-4, 0, 0}, goal, {}, config);
  EXPECT_EQ(driven.end, DriveEnd::Nearest) << driven.reason;
  EXPECT_EQ(driven.collisions, 0);
  ASSERT_TRUE(driven.refusal && driven.refusal->nearest);
  const TPose2D end = driven.rows.back().pose, nearest = *driven.refusal->nearest;
  EXPECT_LT(std::hypot(end.x - nearest.x, end.y - nearest.y), 0.3);
  EXPECT_LT(std::hypot(end.x - goal.x, end.y - goal.y), 1.2);
}

TEST(Drives, EndBesideAWallWhereTheMapLeavesNoRoomForTheLastCentimeters) {
  synthetic_world::Solids solids;
  addWall(solids, {4, -6}, {4, 6});
  World world = plain(solids);
  int asGood = 0;
  for (const double x : {2.8, 2.85, 2.9}) {
    const TPose2D goal(x, 0, 0);  // half a meter from its front to the wall
    DriveLoop loop(smallConfig(), world, syntheticOrder(), {-4, 0, 0}, goal, {});
    const DriveRecord& record = loop.run();
    EXPECT_EQ(record.end, DriveEnd::Arrived) << x << ": " << record.reason;
    EXPECT_EQ(record.collisions, 0);
    const TPose2D end = record.rows.back().pose, aim = std::as_const(loop).guide().goal();
    EXPECT_LT(std::hypot(end.x - goal.x, end.y - goal.y), 0.3) << x;
    asGood += std::hypot(aim.x - goal.x, aim.y - goal.y) > 0.01 ? 1 : 0;
  }
  EXPECT_GE(asGood, 1);
}

TEST(Drives, WaitForSomebodyWhoStandsAtTheGoalForSomeSeconds) {
  synthetic_world::Solids solids;
  addWall(solids, {5, -6}, {5, 6});  // beams that end there see that somebody is gone
  World world = plain(solids);
  Events events;
  events.persons.push_back({0, 3, {2, 0}, {2, 0}, 1});
  const DriveRecord record = drive(world, {-6, 0, 0}, {2, 0, 0}, events);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_FALSE(record.refusal);
  events.persons.front().end = 1e9;
  EXPECT_TRUE(drive(world, {-6, 0, 0}, {2, 0, 0}, events).refusal);
}

TEST(Drives, StopWhereTheGoalIsSeenToBeEnclosedInAnOpenWorld) {
  World world = open();
  DriveConfig config = smallConfig();
  config.timeLimit = 400;
  Events events;
  events.roadblocks = barriersAround({6, 0}, 3);
  DriveLoop loop(config, world, syntheticOrder(), {-4, 0, 0}, {6, 0, 0}, events);
  const DriveRecord record = loop.run();
  EXPECT_EQ(record.end, DriveEnd::Unreachable);
  EXPECT_EQ(record.reason.find("the goal, with "), 0u) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_LE(std::as_const(loop).guide().explored(), 15u);  // some at each side
  EXPECT_LT(record.duration(), 120);
}

TEST(Drives, FindTheGapOnTheFarSideOfBarriersAroundTheGoal) {
  World world = open();
  Events events;
  events.roadblocks = barriersAround({6, 0}, 3);
  events.roadblocks.front() = {0, {9, -1.5}, 0, 3};  // leaves half of the side away from the start
  DriveConfig config = smallConfig();
  config.timeLimit = 200;
  const DriveRecord record = drive(world, {-4, 0, 0}, {6, 0, 0}, events, config);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
}

using namespace semantic_driving;
using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

const TPose2D kStart{0.1, 0.1, 0};

double distanceOf(const TPose2D& a, const TPose2D& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/** Flat ground, 16 m by 16 m, with walls and mud, which is forbidden; nothing beyond is known. */
class GoalFit : public testing::Test {
 protected:
  GoalFit() {
    world.floor(-8, 8, -8, 8, PaintedWorld::Road);
    world.floor(-7, -4, -7, -4, PaintedWorld::Mud);
    world.box(3, 3.2, -8, 4, 0, 1.4, PaintedWorld::Wall);
    world.box(-3, -1, 4, 4.2, 0, 1.4, PaintedWorld::Wall);
  }

  PaintedWorld world;
};

}  // namespace

TEST_F(GoalFit, IsRefusedWhereAPlannerThatKnowsAllSeesAnObstacle) {
  const SemanticPlanner planner = plannerOver(world);
  synthetic_world::Random random(5);
  int refused = 0, free = 0;
  for (int i = 0; i < 3000; ++i) {
    // As far from the border that the vehicle does not reach it.
    const TPose2D goal(random.uniform(-6.5, 6.5), random.uniform(-6.5, 6.5),
                       random.uniform(-M_PI, M_PI));
    const bool fits = planner.check(goal, 0.0) == PlanStatus::Found;
    const auto misfit = findMisfit(planner, kStart, 0, goal);
    EXPECT_EQ(misfit.has_value(), !fits) << goal.asString();
    (fits ? free : refused) += 1;
    if (misfit) {
      EXPECT_LT(std::hypot(misfit->at.x - goal.x, misfit->at.y - goal.y), 1.3);
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(free, 500);
}

TEST_F(GoalFit, SaysWhatIsThere) {
  const SemanticPlanner planner = plannerOver(world);
  const auto classes = PaintedWorld::classTable();
  const TPose2D atWall(2.6, 0.1, 1.57), inMud(-5.5, -5.48, 0);
  EXPECT_EQ(describe(*findMisfit(planner, kStart, 0, atWall), atWall, classes),
            "the goal (2.60, 0.10) does not fit: wall is at (3.10, 0.10)");
  EXPECT_EQ(describe(*findMisfit(planner, kStart, 0, inMud), inMud, classes),
            "the goal (-5.50, -5.48) does not fit: mud is at (-5.50, -5.30)");
}

TEST_F(GoalFit, IsNotRefusedForWhatIsNotKnown) {
  const SemanticPlanner planner = plannerOver(world);
  for (const TPose2D& goal : {TPose2D(7.9, 6, 0), TPose2D(9, 6, 0), TPose2D(30, 0, 0)}) {
    EXPECT_NE(planner.check(goal), PlanStatus::Found);
    EXPECT_FALSE(findMisfit(planner, kStart, 0, goal));
  }
}

TEST_F(GoalFit, IsNotRefusedForGroundThatIsSteepWhereItIsOnlyGuessed) {
  synthetic_world::Random random(7);
  for (double y = -8; y < 8; y += 0.6) {
    const double top = 0.2 * std::floor(random.uniform(0, 5));
    world.box(10, 10.2, y, y + 0.2, top - 0.2, top, PaintedWorld::Road);
  }
  const SemanticPlanner planner = plannerOver(world);
  int steep = 0;
  for (double y = -7; y < 7; y += 0.1) {
    const TPose2D goal(9.1, y, M_PI / 2);
    steep += planner.check(goal, 0.4) == PlanStatus::StartBlocked;
    EXPECT_FALSE(findMisfit(planner, kStart, 0, goal)) << goal.asString();
  }
  EXPECT_GT(steep, 20);
}

TEST_F(GoalFit, OfAThingAmongTheUnknownNothingIsSaid) {
  world.box(12, 12.2, -1, 1, 0.6, 1.4, PaintedWorld::Wall);  // a board, 4 m beyond all ground
  EXPECT_FALSE(findMisfit(plannerOver(world), kStart, 0, {12, 0, 0}));
}

TEST_F(GoalFit, NoPoseWithTheGoalsHeadingIsNearerThanTheNearest) {
  const SemanticPlanner planner = plannerOver(world);
  const TPose2D goal(3.1, -2, 0);
  const auto nearest = nearestFit(planner, kStart, 0, goal, 5);
  ASSERT_TRUE(nearest);
  synthetic_world::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const TPose2D other(goal.x - random.uniform(0, 2), goal.y + random.uniform(-2, 2), goal.phi);
    if (distanceOf(other, goal) > distanceOf(*nearest, goal) - 0.3)
      continue;  // between those tried
    EXPECT_NE(planner.check(other), PlanStatus::Found) << other.asString();
  }
}

TEST_F(GoalFit, TheNearestPoseFitsAndIsOnThisSideOfTheWall) {
  const SemanticPlanner planner = plannerOver(world);
  for (const TPose2D& goal :
       {TPose2D(3.1, -2, 0), TPose2D(3.6, -6, 1.57), TPose2D(-5.5, -5.5, 2)}) {
    const auto nearest = nearestFit(planner, kStart, 0, goal, 5);
    ASSERT_TRUE(nearest) << goal.asString();
    EXPECT_EQ(planner.check(*nearest), PlanStatus::Found);
    EXPECT_LT(distanceOf(*nearest, goal), 2.5);
  }
  // Beyond the wall's end one gets to the other side.
  EXPECT_GT(nearestFit(planner, kStart, 0, {4.2, 0, 1.57}, 5)->x, 3.2);
}

TEST_F(GoalFit, BehindAWallWithoutAnEndNothingIsOffered) {
  world.box(3, 3.2, 4, 8, 0, 1.4, PaintedWorld::Wall);
  EXPECT_FALSE(nearestFit(plannerOver(world), kStart, 0, {6, 0, 0}, 2));
}
