// Drives to goals that cannot be reached, or only seem so.
#include <gtest/gtest.h>

#include <cmath>

#include "PlainDrives.h"

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
  EXPECT_NE(told.reason.find("; the nearest pose known to fit: "), std::string::npos);
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
