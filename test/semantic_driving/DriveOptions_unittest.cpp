#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_driving/PathTracker.h>

#include <algorithm>
#include <cmath>

#include "PathOfArcs.h"
#include "TemporaryFolder.h"
#include "simulated_drive/DriveConfig.h"

using namespace semantic_driving;

namespace {

const std::vector<Eigen::Vector2d> kFootprint = {
    {-0.25, -0.3}, {0.55, -0.3}, {0.55, 0.3}, {-0.25, 0.3}};

/** Where a vehicle at full speed stands that is left the way to come to rest: x less the end of
 * that way, m. */
double overshoot(double acceleration) {
  DriveOptions options;
  options.maxAcceleration = acceleration;
  PathTracker tracker(options, kFootprint);
  simulated_drive::SimulatedRobot robot({0, 0, 0}, options);
  const auto drive = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      tracker.locate(robot.state());
      robot.drive(tracker.command(robot.state(), {}, options.maxSpeed), 0.1);
    }
  };
  tracker.setPath(pathOfArcs({{60, 0}}));
  drive(200);
  EXPECT_NEAR(robot.state().speed, options.maxSpeed, 1e-6) << acceleration;
  tracker.locate(robot.state());
  const double here = tracker.progress();
  const double way = restingWay(robot.state().speed, options) + 0.1;  // DriveGuide's margin
  const double end = robot.state().pose.x + way;
  tracker.setPath(tracker.path().part(here, here + way));
  drive(300);
  EXPECT_NEAR(robot.state().speed, 0, 1e-6) << acceleration;
  return robot.state().pose.x - end;
}

/** \param lines behind "reactive = ..." of [drive] */
simulated_drive::DriveConfig loaded(const std::string& lines) {
  const TemporaryFolder folder;  // tests run side by side
  return simulated_drive::loadDriveConfig(folder.write(
      "drive.ini", "[drive]\nreactive = " MSO_SOURCE_DIR "/config/reactive/robot.ini\n" + lines));
}

/** What is wrong with a configuration; empty: nothing. */
std::string faultOf(const std::string& lines) {
  try {
    loaded(lines);
    return {};
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

TEST(DriveOptions, BendsAreDrivenNoFasterThanTheAccelerationAllows) {
  constexpr double kRadius = 3;  // m
  for (const double acceleration : {0.05, 0.1, 0.2}) {
    DriveOptions options;
    options.maxAcceleration = acceleration;
    PathTracker tracker(options, kFootprint);
    tracker.setPath(pathOfArcs({{10, 1 / kRadius}}));
    simulated_drive::SimulatedRobot robot({0, 0, 0}, options);
    double fastest = 0;
    for (int i = 0; i < 300; ++i) {
      tracker.locate(robot.state());
      robot.drive(tracker.command(robot.state(), {}, options.maxSpeed), 0.1);
      fastest = std::max(fastest, robot.state().speed);
    }
    EXPECT_NEAR(fastest * fastest / kRadius, acceleration, 0.1 * acceleration);
  }
}

TEST(DriveOptions, TheWayToRestIsLongEnoughForSlowVehicles) {
  for (const double acceleration : {0.15, 0.3, 0.6, 0.8, 2.0})
    EXPECT_LT(overshoot(acceleration), 0.1) << acceleration;
}

TEST(DriveOptions, HoweverFastAVehicleIsItStandsBeforeItIsBlind) {
  for (const double maxSpeed : {0.5, 1.2, 5.0}) {
    DriveOptions options;
    options.maxSpeed = maxSpeed;
    EXPECT_NEAR(options.speedFor(0), std::min(maxSpeed, options.braking() * 2.4), 1e-9);
    double before = options.speedFor(0);
    for (double age = 0.1; age < 2.5; age += 0.1) {
      const double speed = options.speedFor(age);
      EXPECT_LE(speed, before);
      EXPECT_LE(speed * speed / (2 * options.braking()), speed * (2.4 - age) / 2 + 1e-9);
      before = speed;
    }
    EXPECT_NEAR(options.speedFor(2.4), 0, 1e-9);
  }
}

TEST(DriveOptions, SpeedsOfClassesFollowTheOrder) {
  DriveOptions options;
  options.slowRank = 1;
  options.slowRankSpeed = 0.4;
  const colored_graph::ClassOrder order(5, {{1}, {2}});
  EXPECT_EQ(options.classSpeeds(order), (std::vector<double>{0.4, 1, 0.4, 0.4, 0.4}));
}

TEST(DriveOptions, AreReadFromTheirSections) {
  const auto config = loaded(
      "max_speed = 0.5\ncontrol_period = 0.05\n[guide]\nat_goal = 0.2\n"
      "patience = 3\n[pose]\nturn_noise = 2\n[slam]\nlevel = true\n");
  EXPECT_EQ(config.drive.maxSpeed, 0.5);
  EXPECT_EQ(config.controlPeriod, 0.05);
  EXPECT_EQ(config.guide.atGoal, 0.2);
  EXPECT_EQ(config.guide.patience, 3);
  EXPECT_EQ(config.pose.turnNoise, 2);
  EXPECT_TRUE(config.slam.level);
}

TEST(DriveOptions, WhatTheVehicleAndTheMapSayTheyFollow) {
  DriveOptions options;
  options.setFor(4, 0.05);
  EXPECT_LT(options.turningRadius, 4);
  EXPECT_EQ(options.margin, 0.025);
  for (const double speed : {0.3, 1.2, 8.0})
    for (const double acceleration : {0.2, 0.8, 3.0}) {
      options.maxSpeed = speed, options.maxAcceleration = acceleration;
      EXPECT_GT(options.lookAhead(), restingWay(speed, options) + speed * options.reactionTime);
      EXPECT_GT(options.lookAhead(), 2 * options.turningRadius);
    }
  semantic_navigation::NavigatorOptions navigation;
  navigation.drive.maxSpeed = 8;
  navigation.setFor(0.2);
  EXPECT_GT(navigation.obstacleRadius(), navigation.drive.lookAhead());
  EXPECT_GT(navigation.movers.radius, navigation.obstacleRadius());
  EXPECT_GT(navigation.focus.around, navigation.obstacleRadius());
}

TEST(DriveOptions, SaysWhatIsWrongInAConfiguration) {
  EXPECT_TRUE(contains(faultOf("max_sped = 1\n"), "did you mean 'max_speed'"));
  EXPECT_TRUE(contains(faultOf("max_speed = 0\n"), "[drive] max_speed is 0"));
  EXPECT_TRUE(contains(faultOf("[guid]\nperiod = 3\n"), "did you mean 'guide'"));
  EXPECT_TRUE(contains(faultOf("[guide]\nat_goal = 0\n"), "at_goal is 0"));
  EXPECT_TRUE(contains(faultOf("[movers]\nclasses = ghost\n"),
                       "ini: DynamicObstacleOptions: 'ghost' is no class"));
  EXPECT_TRUE(contains(faultOf("[sensors]\ncamera = no\nlidar = no\n"), "both off"));
}

constexpr double kPeriod = 0.1;  // s

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 1001) / 1000.0;
}

}  // namespace

TEST(Motion, KeepsToItsLimitsWhateverIsWanted) {
  EXPECT_TRUE(rc::check([] {
    DriveOptions limits;
    limits.maxJerk = between(0.5, 10);
    limits.turningRadius = between(0.3, 8);
    limits.maxAcceleration = between(0.3, 3);
    Motion motion;
    for (int i = 0; i < 60; ++i) {
      const DriveCommand wanted{between(-1, 1), between(-1, 1)};
      const Motion now = next(motion, wanted, motion.speed, kPeriod, limits);
      RC_ASSERT(std::abs(now.acceleration) <= limits.maxAcceleration + 1e-9);
      RC_ASSERT(std::abs(now.acceleration - motion.acceleration) <=
                limits.maxJerk * kPeriod + 1e-9);
      RC_ASSERT(std::abs(now.curvature - motion.curvature) <=
                limits.steeringRate() * kPeriod + 1e-9);
      RC_ASSERT(std::abs(now.speed - motion.speed - now.acceleration * kPeriod) <= 1e-9);
      motion = now;
    }
  }));
}

TEST(Motion, ReachesASpeedWithoutGoingBeyond) {
  const DriveOptions limits;
  for (double wanted = -1.2; wanted <= 1.2; wanted += 0.01) {
    Motion motion;
    for (int i = 0; i < 40; ++i) {
      motion = next(motion, {wanted, 0}, motion.speed, kPeriod, limits);
      EXPECT_LT(std::abs(motion.speed), std::abs(wanted) + 1e-9);
    }
    EXPECT_NEAR(motion.speed, wanted, 1e-6);
  }
}

TEST(Motion, AStopIsDelayedByNoMoreThanIsSaid) {
  const DriveOptions limits;
  for (const double acceleration : {0.0, 0.3, 0.8}) {
    Motion motion;
    motion.speed = 1, motion.acceleration = acceleration;
    double way = 0;
    for (int i = 0; i < 60; ++i) {
      const Motion now = next(motion, {}, motion.speed, kPeriod, limits);
      way += (motion.speed + now.speed) / 2 * kPeriod;
      motion = now;
    }
    EXPECT_NEAR(motion.speed, 0, 1e-6);
    const double atOnce = 1 / (2 * limits.maxAcceleration);
    // A little more, as it ends gently, too.
    EXPECT_LT(way, atOnce + delayOfStop(acceleration, limits) + 0.06) << acceleration;
    EXPECT_GT(way, atOnce);
  }
}

TEST(Motion, IsSlowWhereTheSteeringIsNotThereYet) {
  const DriveOptions limits;
  Motion motion;
  motion.speed = 0.5, motion.curvature = -1;
  motion = next(motion, {1, 1}, 0.5, kPeriod, limits);  // 2 1/m to turn
  EXPECT_LT(motion.speed, 0.5);
  EXPECT_NEAR(motion.curvature, -0.8, 1e-9);
}
