#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/nav/reactive/CLogFileRecord.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_driving/DriveController.h>
#include <semantic_driving/ObstacleSensing.h>

#include <algorithm>
#include <cmath>

#include "CompressedInput.h"
#include "PathOfArcs.h"
#include "ReactiveSystem.h"
#include "TemporaryFolder.h"
#include "simulated_drive/DriveConfig.h"

using namespace semantic_driving;
using namespace semantic_planning;

namespace {

const auto kRobotFootprint = semantic_planning::Footprint::rectangle(-0.25, 0.55, 0.6);

ReactiveNavigator::Options optionsOf(const Footprint& footprint) {
  ReactiveNavigator::Options options;
  options.config = std::string(MSO_SOURCE_DIR) + "/config/reactive/robot.ini";
  options.footprint = footprint;
  return options;
}

/** Straight on for 4 m, an arc to the left by an angle, and straight on again for 6 m. */
DrivePath bend(double radius, double angle) {
  return pathOfArcs({{4, 0}, {radius * angle, 1 / radius}, {6, 0}});
}

/** Columns of a map that somebody fills who stands in the way, 6 m ahead; map frame. */
std::vector<Eigen::Vector2d> person() {
  std::vector<Eigen::Vector2d> columns;
  for (const double x : {5.9, 6.1})
    for (const double y : {-0.2, 0.0, 0.2}) columns.emplace_back(x, y);
  return columns;
}

class Drive {
 public:
  Drive() : m_robot({0, 0, 0}, {}) { mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated); }

  const DriveState& state() const { return m_robot.state(); }
  bool collided() const { return m_collided; }

  /** Until half a minute is over: one command each 0.1 s. */
  template <class Command>
  void run(Command command, const std::vector<Eigen::Vector2d>& columns = person()) {
    const PathTracker outline({}, kRobotFootprint);
    for (int i = 0; i < 300; ++i) {
      mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + 0.1 * i));
      const ObstaclePoints seen = seenFrom(columns, {}, state().pose, 100);
      m_collided = m_collided || !outline.isFree({}, seen, 1e-6);
      m_robot.drive(command(seen, 0.1 * i), 0.1);
    }
  }

 private:
  simulated_drive::SimulatedRobot m_robot;
  bool m_collided = false;
};

TEST(DriveController, PassesAPersonByTheReactiveNavigatorWithoutANewPath) {
  DriveController controller({}, optionsOf(kRobotFootprint));
  controller.setPath(pathOfArcs({{12, 0}}));
  Drive drive;
  int reactiveSteps = 0;
  drive.run([&](const ObstaclePoints& seen, double seconds) {
    const DriveCommand command = controller.step(drive.state(), seen, 0, seconds);
    reactiveSteps += controller.isReactive() ? 1 : 0;
    return command;
  });
  EXPECT_FALSE(drive.collided());
  EXPECT_GT(reactiveSteps, 20);
  EXPECT_TRUE(controller.tracker().finished());
  EXPECT_NEAR(drive.state().pose.x, 12, 0.3);
  EXPECT_NEAR(drive.state().pose.y, 0, 0.3);
}

TEST(PathTracker, DoesNotSteerTheOtherWayAfterABend) {
  for (const double speed : {0.6, 0.8, 1.2})
    for (const double angle : {0.3, 0.8, 1.6, 2.5}) {
      DriveOptions options;
      options.maxSpeed = speed;
      DriveController controller(options, optionsOf(kRobotFootprint));
      controller.setPath(bend(1.1, angle));
      Drive drive;
      double least = 0, most = 0;
      drive.run(
          [&](const ObstaclePoints& seen, double seconds) {
            const DriveCommand command = controller.step(drive.state(), seen, 0, seconds);
            least = std::min(least, drive.state().turn);
            most = std::max(most, drive.state().turn);
            return command;
          },
          {});
      EXPECT_TRUE(controller.tracker().finished());
      EXPECT_GT(most, 0.3 * speed);
      EXPECT_GT(least, -0.02) << speed << " m/s, " << angle << " rad";
    }
}

ReactiveNavigator::Options optionsOf(double width) {
  return optionsOf(Footprint::rectangle(0, 0.6, width));
}

/** A wall across the straight way, 3 m ahead, with a gap of 0.9 m in the middle; map frame. */
ObstaclePoints wallWithGap() {
  ObstaclePoints points;
  for (double y = 0.45; y < 4; y += 0.2)
    for (const double side : {-1, 1}) points.emplace_back(3.0, side * y);
  return points;
}

/** Whether it drives 6 m ahead, through the gap, within a quarter of a minute. */
bool getsThrough(const ReactiveNavigator::Options& options) {
  ReactiveNavigator navigator(options, {});
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  simulated_drive::SimulatedRobot robot({0, 0, 0}, {});
  PathPoint goal;
  goal.x = 6;
  navigator.setWaypoints({goal}, 0.4);
  for (int i = 0; i < 150; ++i) {
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + 0.1 * i));
    const auto seen = seenFrom(wallWithGap(), {}, robot.state().pose, 100);
    robot.drive(navigator.step(robot.state(), seen, 0.1 * i), 0.1);
    if (navigator.status() == ReactiveNavigator::Status::Arrived) return true;
  }
  return false;
}

}  // namespace

TEST(ReactiveNavigator, GoesThroughAGapWhereItFits) {
  EXPECT_TRUE(getsThrough(optionsOf(0.2)));
  EXPECT_FALSE(getsThrough(optionsOf(0.9)));
}

TEST(ReactiveNavigator, GoesAroundABendWithoutAStop) {
  ReactiveNavigator navigator(optionsOf(0.2), {});
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  simulated_drive::SimulatedRobot robot({0, 0, 0}, {});
  constexpr double kRadius = 2, kSpacing = 1.2, kTurn = M_PI / 2;  // m, m, rad
  std::vector<PathPoint> places;
  for (double way = kSpacing; places.size() < 10; way += kSpacing) {
    const double angle = std::min(way / kRadius, kTurn);
    PathPoint place;
    place.x = kRadius * std::sin(angle);
    place.y = kRadius * (1 - std::cos(angle)) + way - kRadius * angle;
    places.push_back(place);
  }
  navigator.setWaypoints(places, 0.5);
  double slowest = 1, seconds = 0;
  do {
    mrpt::Clock::setSimulatedTime(mrpt::Clock::fromDouble(1e9 + seconds));
    robot.drive(navigator.step(robot.state(), ObstaclePoints(), seconds), 0.1);
    seconds += 0.1;
    if (seconds > 2 && robot.state().pose.y < places.back().y - 2)
      slowest = std::min(slowest, robot.state().speed);
  } while (navigator.status() == ReactiveNavigator::Status::Driving && seconds < 30);
  EXPECT_EQ(navigator.status(), ReactiveNavigator::Status::Arrived);
  EXPECT_NEAR(robot.state().pose.y, places.back().y, 0.6);
  EXPECT_GT(slowest, 0.5);
}

TEST(ReactiveNavigator, CompletesTheFactorsThatNewerReleasesOfMrptWant) {
  mrpt::config::CConfigFileMemory file(
      std::string("[CHolonomicFullEval]\nfactorWeights = [0.25, 0.1, 1, 0.05, 0.5, 1, 1]\n"
                  "factorNormalizeOrNot = [0, 0, 0, 0, 1, 1, 0]\n"));
  const auto read = [&](const std::string& key) {
    std::vector<double> values;
    file.read_vector("CHolonomicFullEval", key, values, values);
    return values;
  };
  completeHolonomicFactors(file, 7);
  EXPECT_EQ(read("factorWeights").size(), 7u);
  completeHolonomicFactors(file, 8);
  EXPECT_EQ(read("factorWeights"), (std::vector<double>{0.25, 0.1, 1, 0.05, 0.5, 1, 1, 0}));
  EXPECT_EQ(read("factorNormalizeOrNot"), (std::vector<double>{0, 0, 0, 0, 1, 1, 0, 0}));
  completeHolonomicFactors(file, 8);
  EXPECT_EQ(read("factorWeights").size(), 8u);
}

TEST(ReactiveNavigator, WritesALogThatMrptReads) {
  const TemporaryFolder folder;
  ReactiveNavigator::Options options = optionsOf(0.2);
  options.logFolder = folder.path();
  EXPECT_TRUE(getsThrough(options));
  CompressedInput file((folder / "log_000.reactivenavlog").string());
  auto archive = mrpt::serialization::archiveFrom(file);
  int records = 0;
  double farthest = 0;
  try {
    for (;; ++records) {
      mrpt::nav::CLogFileRecord record;
      archive >> record;
      EXPECT_EQ(record.WS_Obstacles.size(), wallWithGap().size());
      EXPECT_EQ(record.infoPerPTG.size(), 3u);  // two, and going on as before
      farthest = std::max(farthest, record.robotPoseLocalization.x);
    }
  } catch (const std::exception&) {  // the end
  }
  EXPECT_GT(records, 30);
  EXPECT_GT(farthest, 4);
}
