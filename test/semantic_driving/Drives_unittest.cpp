#include <gtest/gtest.h>
#include <synthetic_world/Scene.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "PlainDrives.h"
#include "Trial.h"
#include "simulated_drive/DriveLoop.h"

using namespace plain_drives;

namespace {

double greatestSpeed(const DriveRecord& record, double from, double to) {
  double greatest = 0;
  for (const DriveRow& row : record.rows)
    if (row.time >= from && row.time < to) greatest = std::max(greatest, std::abs(row.speed));
  return greatest;
}

/** The greatest speed with which it touched something, m/s; 0: it did not. */
double contactSpeed(const DriveRecord& record) {
  double greatest = 0;
  for (const DriveRow& row : record.rows)
    if (row.clearance <= 0) greatest = std::max(greatest, std::abs(row.speed));
  return greatest;
}

/** When the robot passes x = `at` ahead. */
const DriveRow& passing(const DriveRecord& record, double at) {
  return *std::find_if(record.rows.begin(), record.rows.end(), [at](const DriveRow& r) {
    return r.pose.x >= at && std::cos(r.pose.phi) > 0.8;
  });
}

/** Somebody who steps into the robot's way when it passes x = `at`, `before` meters ahead of it. */
Events::Person stepsInFront(const DriveRecord& record, double at, double before) {
  constexpr double kFront = 0.55, kAside = 0.9, kSpeed = 1.5;  // m, m, m/s
  const DriveRow& row = passing(record, at);
  const auto there = std::find_if(record.rows.begin(), record.rows.end(), [&](const DriveRow& r) {
    return r.time > row.time &&
           std::hypot(r.pose.x - row.pose.x, r.pose.y - row.pose.y) >= kFront + before;
  });
  const auto placed = [&](double side) {
    const auto p = there->pose.composePoint({0, side});
    return Eigen::Vector2d(p.x, p.y);
  };
  return {row.time - kAside / kSpeed, 1e9, placed(kAside), placed(0), kSpeed};
}

/** Whether a robot drove over a place. */
bool passesOver(const DriveRecord& record, const Eigen::Vector2d& place) {
  return std::any_of(record.rows.begin(), record.rows.end(), [&](const DriveRow& row) {
    const auto p = row.pose.inverseComposePoint({place.x(), place.y()});
    return p.x > -0.25 && p.x < 0.55 && std::abs(p.y) < 0.3;  // the footprint
  });
}

/** Where a drive last came from x < 0: y, meters. */
double crossing(const DriveRecord& record) {
  double y = std::nan("");
  for (const DriveRow& row : record.rows)
    if (row.pose.x < 0) y = row.pose.y;
  return y;
}

}  // namespace

TEST(Drives, BeginWithoutAMapAndArriveOnTheRoad) {
  World world = plain();
  const DriveRecord record = drive(world, {-8, 0, 0}, {8, 0, 0});
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_LT(badLength(record.drivenPerClass, syntheticOrder()), 0.5);
}

TEST(Drives, StopBeforeWhatAppearsThoughTheMapHasItLater) {
  DriveConfig config = smallConfig();
  config.mappingLatency = 0.3;
  World world = plain();
  const DriveRecord before = drive(world, {-8, 0, 0}, {8, 0, 0}, {}, config);
  Events events;
  events.roadblocks.push_back({passing(before, -2).time, {2, 0}, M_PI / 2, 3});
  const DriveRecord record = drive(world, {-8, 0, 0}, {8, 0, 0}, events, config);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
}

TEST(Drives, InsertWhatTheyCanWhenMappingIsSlowerThanTheSensors) {
  DriveConfig config = smallConfig();
  config.mappingLatency = 0.7;
  config.drive.maxSensorAge = 1.5;
  World world = plain();
  const DriveRecord record = drive(world, {-8, 0, 0}, {4, 0, 0}, {}, config);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_NEAR(record.leaves.size(), record.duration() / (2 * config.sensors.period), 2)
      << "each second scan";
}

TEST(Drives, AreAtRestWhereSomebodyWalksIntoTheirSide) {
  World world = plain();
  const TPose2D start(-8, 0, 0), goal(8, 0, 0);
  DriveConfig careless = smallConfig(), careful = smallConfig();
  careless.movers.classes = "";
  const DriveRow row = passing(drive(world, start, goal, {}, careful), -1);
  for (const double speed : {0.7, 1.8}) {
    SCOPED_TRACE(speed);
    const double side = row.pose.y < 1 ? 1 : -1, far = speed * 3.5;  // m
    const auto at = [&](double y) {
      const auto p = row.pose.composePoint({0.3, side * y});
      return Eigen::Vector2d(p.x, p.y);
    };
    Events events;  // through its side, and away
    events.persons.push_back({row.time - 3.5, row.time + 4, at(far), at(-far), speed});
    EXPECT_GT(contactSpeed(drive(world, start, goal, events, careless)), 0.3);
    const DriveRecord record = drive(world, start, goal, events, careful);
    EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
    EXPECT_LE(contactSpeed(record), 0.1);
  }
}

/** Sensors see neither legs nor head of who is near: what he leaves there must not stay. */
TEST(Drives, StepOutOfTheWayOfSomebodyWhoWalksIntoThemAndGoOn) {
  for (const double side : {0.0, 0.3}) {
    SCOPED_TRACE(side);
    World world = plain();
    DriveConfig config = smallConfig();
    config.mappingLatency = 0.3;
    Events events;
    events.persons.push_back({2, 1e9, {10, side}, {-14, side}, 1.2});
    const DriveRecord record = drive(world, {-8, 0, 0}, {8, 0, 0}, events, config);
    EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
    EXPECT_EQ(record.collisions, 0);
  }
}

TEST(Drives, GetAroundAPersonWhoStepsInFrontAndStays) {
  World world = plain();
  const TPose2D start(-8, 0, 0), goal(8, 0, 0);
  const DriveRecord free = drive(world, start, goal);
  for (const double before : {1.0, 1.3, 1.5}) {  // to react and stop it takes 1.3 m
    SCOPED_TRACE(before);
    Events events;
    events.persons.push_back(stepsInFront(free, -1, before));
    const DriveRecord record = drive(world, start, goal, events);
    EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
    EXPECT_EQ(record.collisions, 0);
    EXPECT_TRUE(passesOver(free, events.persons[0].to));
    EXPECT_FALSE(passesOver(record, events.persons[0].to));
  }
}

TEST(Drives, LeaveAPersonToTheReactiveNavigatorWithoutANewPlan) {
  World world = plain();
  DriveConfig config = smallConfig();
  config.guide.patience = config.timeLimit;  // no other plan than the first
  const TPose2D start(-6, 0, 0), goal(3, 0, 0);
  const auto driveKnowing = [&](const Events& events) {  // the ground, but for the person
    DriveLoop loop(config, world, syntheticOrder(), start, goal, events,
                   std::make_unique<semantic_octree::StoredMap>(
                       drive_study::trueMap(world, config.voxelSize, 1.4)));
    return loop.run();
  };
  Events events;
  events.persons.push_back(stepsInFront(driveKnowing({}), -3, 2.5));
  const DriveRecord record = driveKnowing(events);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_EQ(record.replans, 0);
  EXPECT_LT(record.leastClearance, 1);
  EXPECT_TRUE(std::any_of(record.rows.begin(), record.rows.end(),
                          [](const DriveRow& row) { return row.isReactive; }));
}

TEST(Drives, TakeAnotherWayWhenTheRoadIsBlocked) {
  synthetic_world::Solids solids;  // two gaps in a wall across
  addWall(solids, {0, -20}, {0, -6});
  addWall(solids, {0, -3}, {0, 3});
  addWall(solids, {0, 6}, {0, 20});
  World world = plain(solids, 16);
  const TPose2D start(-8, 4.5, 0), goal(8, 4.5, 0);
  EXPECT_NEAR(crossing(drive(world, start, goal)), 4.5, 1.5);
  Events events;
  events.roadblocks.push_back({5, {0, 4.5}, 0, 3.4});
  const DriveRecord record = drive(world, start, goal, events);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_NEAR(crossing(record), -4.5, 1.5);
}

TEST(Drives, KeepJerkAndSteeringWithinTheirLimitsAndGoSlowlyOnGrass) {
  World world = plain({}, 4);
  const DriveConfig config = smallConfig();
  const DriveRecord record = drive(world, {-8, 0, 0}, {4, 8, 1.57});
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_LT(smoothnessOf(record).jerk, config.drive.maxJerk * 1.05);
  double onGrass = 0;
  for (std::size_t i = 1; i < record.rows.size(); ++i) {
    const DriveRow &a = record.rows[i - 1], &b = record.rows[i];
    if (std::abs(a.speed) > 0.3 && a.speed * b.speed > 0) {
      EXPECT_LT(std::abs(b.turn / b.speed - a.turn / a.speed),
                config.drive.steeringRate() * 0.1 * 1.5)
          << b.time;
    }
    if (b.classId == synthetic_world::kGrass && std::abs(b.pose.y) > 3.5)
      onGrass = std::max(onGrass, std::abs(b.speed));
  }
  EXPECT_GT(greatestSpeed(record, 0, 1e9), 1);
  EXPECT_GT(onGrass, 0.5);
  EXPECT_LT(onGrass, config.drive.slowRankSpeed + 0.05);
}

TEST(Drives, SlowDownWhileTheSensorsAreOut) {
  World world = plain();
  Events events;
  events.dropouts.push_back({6, 8});
  const DriveRecord record = drive(world, {-8, 0, 0}, {8, 0, 0}, events);
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_GT(greatestSpeed(record, 4, 6), 0.7);
  EXPECT_LT(greatestSpeed(record, 7.9, 8), 0.5);
}

TEST(Drives, LeaveForbiddenGroundTheShortestWay) {
  synthetic_world::GroundCover cover(20, synthetic_world::kRoad);
  cover.paintBand(synthetic_world::kFlowerBed, {-12, 0}, {-2, 0}, 6);
  World world(synthetic_world::Terrain(20, {}), cover, {});
  const DriveRecord record = drive(world, {-8, 1, 1.57}, {8, 0, 0});
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_LT(record.drivenPerClass[synthetic_world::kFlowerBed], 3.5);
}
