#include <gtest/gtest.h>
#include <semantic_driving/DriveController.h>
#include <semantic_driving/DynamicObstacles.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "Classes.h"
#include "PathOfArcs.h"
#include "StepAside.h"
#include "simulated_drive/DriveConfig.h"

using namespace semantic_driving;
using Eigen::Vector2d;
using mrpt::math::TPose2D;

namespace {

constexpr double kPeriod = 0.1;  // s
constexpr int kPerScan = 5;
constexpr double kBody = 0.3;                                               // m, radius of a person
constexpr double kRobotBack = -0.25, kRobotFront = 0.55, kRobotHalf = 0.3;  // m, of the robot

/** Walks straight on. */
struct Person {
  Vector2d from, velocity;
  Vector2d at(double seconds) const { return from + seconds * velocity; }
};

/** A quarter of a circle to the left between two straights. */
DrivePath bent() {
  constexpr double kArc = 3 * M_PI / 2;  // m
  return pathOfArcs({{6, 0}, {kArc, 1 / 3.0}, {14 - kArc, 0}});
}

/** Meters between the robot and a person's body; the rectangle's corners are all it knows. */
double gap(const TPose2D& robot, const Vector2d& person) {
  const auto p = robot.inverseComposePoint({person.x(), person.y()});
  const double x = std::max({kRobotBack - p.x, 0.0, p.x - kRobotFront});
  const double y = std::max(0.0, std::abs(p.y) - kRobotHalf);
  return std::hypot(x, y) - kBody;
}

/** Points of the side of the body that the sensor sees, with noise, in the map's frame. */
semantic_types::LabeledCloud seen(const Person& person, const TPose2D& robot, double seconds,
                                  std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.03);
  semantic_types::LabeledCloud cloud;
  const Vector2d place = person.at(seconds);
  const double towards = std::atan2(robot.y - place.y(), robot.x - place.x());
  for (double a = towards - 1.2; a <= towards + 1.2; a += 0.3)
    cloud.points.emplace_back(Eigen::Vector3d(place.x() + kBody * std::cos(a) + noise(random),
                                              place.y() + kBody * std::sin(a) + noise(random), 1)
                                  .cast<float>());
  cloud.classes.assign(cloud.points.size(), 1);
  return cloud;
}

struct Outcome {
  double fastestContact = -1;  ///< m/s; negative: none
  double seconds = 1e9;        ///< until the path's end
  double standing = 0;         ///< s

  void add(const semantic_driving::DriveState& state, const std::vector<Person>& persons,
           double time) {
    for (const Person& p : persons)
      if (gap(state.pose, p.at(time)) <= 0)
        fastestContact = std::max(fastestContact, std::abs(state.speed));
    if (std::abs(state.speed) < 0.01) standing += kPeriod;
  }
};

DriveOptions options() {
  DriveOptions options;
  options.maxSpeed = 1.2;
  return options;
}

ReactiveNavigator::Options reactive() {
  ReactiveNavigator::Options reactive;
  reactive.config = std::string(MSO_SOURCE_DIR) + "/config/reactive/robot.ini";
  return reactive;
}

class Robot {
 public:
  /** From the path's beginning. \param predicts the controller is told of those who move */
  Outcome drive(const std::vector<Person>& persons, bool predicts, std::uint32_t seed = 1) {
    m_begin += 1000;
    DynamicObstacleOptions all;
    all.radius = 30;
    DynamicObstacleTracker tracker(all, m_classes);
    m_controller.setPath(bent());
    simulated_drive::SimulatedRobot robot({0, 0, 0}, options());
    std::mt19937 random(seed);
    Outcome outcome;
    for (int step = 0; step < 900; ++step) {
      const double t = step * kPeriod, age = step % kPerScan * kPeriod;
      if (age == 0) {
        for (const Person& p : persons)
          tracker.see(seen(p, robot.state().pose, t, random), Eigen::Isometry3d::Identity());
        tracker.update(t);
      }
      robot.drive(m_controller.step(robot.state(), {}, age, m_begin + t,
                                    predicts ? tracker.at(t) : DynamicObstacles()),
                  kPeriod);
      outcome.add(robot.state(), persons, t + kPeriod);
      if (!m_controller.tracker().finished()) continue;
      outcome.seconds = t;
      break;
    }
    return outcome;
  }

 private:
  const semantic_types::ClassTable m_classes = tableOf({"person"});
  DriveController m_controller{options(), reactive()};
  double m_begin = 0;  ///< s, of the next drive
};

/** Who crosses a place of the path about when the robot gets there, from any side, and does not
 * meet it at its start. */
Person crossing(std::mt19937& random) {
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const PathPoint place = bent().at(between(3, 16));
  const double speed = between(0.5, 2), side = between(-M_PI, M_PI);
  const double when = std::max(2.5, place.arcLength / 1.2 + between(-2, 2));
  const Vector2d velocity(speed * std::cos(side), speed * std::sin(side));
  const Person person{Vector2d(place.x, place.y) - when * velocity, velocity};
  for (double t = 0; t < 2.5; t += kPeriod)
    if (gap({}, person.at(t)) < 1.5) return crossing(random);
  return person;
}

TEST(Separation, WhoeverCrossesFromWhicheverSideFindsTheRobotAtRest) {
  Robot robot;
  std::mt19937 random(7);
  int met = 0, atSpeed = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Person person = crossing(random);
    const Outcome careless = robot.drive({person}, false, i);
    atSpeed += careless.fastestContact > 0.1 ? 1 : 0;
    const Outcome careful = robot.drive({person}, true, i);
    met += careful.fastestContact >= 0 ? 1 : 0;
    EXPECT_LE(careful.fastestContact, 0.1)
        << i << ": from " << person.from.transpose() << " at " << person.velocity.transpose();
    EXPECT_LT(careful.seconds, careless.seconds + 15) << i;
  }
  EXPECT_GT(atSpeed, 60);       // without prediction
  EXPECT_LT(met, atSpeed / 2);  // and at rest
}

TEST(Separation, SeveralWhoCrossFindItAtRest) {
  Robot robot;
  std::mt19937 random(8);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::vector<Person> persons{crossing(random), crossing(random), crossing(random)};
    const Outcome careful = robot.drive(persons, true, i);
    EXPECT_LE(careful.fastestContact, 0.1) << i;
    EXPECT_LT(careful.seconds, 60) << i;
  }
}

TEST(Separation, WhoWalksAwayOrAlongOrStandsAsideDoesNotStopIt) {
  Robot robot;
  const double alone = robot.drive({}, true).seconds;
  const std::vector<Person> others = {
      {{2, 0}, {1.4, 0}},       // ahead and faster
      {{-3, 0}, {-1, 0}},       // behind, away
      {{0, 1.3}, {1.2, 0}},     // beside, at the robot's speed
      {{-4, -1.3}, {1.5, 0}},   // passes
      {{4, -1.3}, {-1.3, 0}},   // towards it, beside
      {{3, -1.2}, {0, 0}},      // stands
      {{-2.5, -0.2}, {1.1, 0}}  // follows
  };
  for (const Person& person : others) {
    SCOPED_TRACE(person.from.transpose());
    const Outcome outcome = robot.drive({person}, true);
    EXPECT_LT(outcome.standing, 3);
    EXPECT_LT(outcome.seconds, alone + 6);
  }
}

TEST(Separation, TheSlowerTheNearerOneStands) {
  const semantic_planning::Footprint footprint;
  const auto along = [](double way) { return TPose2D(way, 0, 0); };
  double before = 0;
  for (const double side : {0.7, 0.8, 0.9, 1.1, 1.5}) {
    DynamicObstacle mover{{1, side}, {0, 0}, 0.35, 0.5};
    const double speed = separationSpeed(along, 0.2, 0, 1.2, {mover}, footprint, options());
    EXPECT_GE(speed, before) << side;
    EXPECT_GE(speed, DriveOptions::kSlowest) << side;
    before = speed;
  }
  EXPECT_EQ(before, 1.2);
}

constexpr double kAsideStep = 0.1;  // s

const semantic_planning::Footprint& robotShape() {
  static const semantic_planning::Footprint robot;
  return robot;
}

DynamicObstacle walkerAt(const Vector2d& place, const Vector2d& velocity) {
  return {place, velocity, 0.35, 0.1};
}

/** A robot at rest that steps aside, and nothing else. */
struct Encounter {
  double leastDistance = 1e9;  ///< m to the one who walks
  double leastRoom = 1e9;      ///< m to what it must not touch
  double way = 0;              ///< m
};

Encounter encounterWith(DynamicObstacle mover, const std::vector<Vector2d>& walls,
                        double seconds = 8) {
  const DriveOptions options;
  Encounter outcome;
  DriveState state;
  Motion motion;
  for (double t = 0; t < seconds; t += kAsideStep) {
    ObstaclePoints room;
    for (const Vector2d& p : walls) {
      const auto seen = state.pose.inverseComposePoint({p.x(), p.y()});
      room.emplace_back(seen.x, seen.y);
      outcome.leastRoom = std::min(outcome.leastRoom, robotShape().distance(room.back()));
    }
    const auto p = state.pose.inverseComposePoint({mover.place.x(), mover.place.y()});
    outcome.leastDistance =
        std::min(outcome.leastDistance, robotShape().distance({p.x, p.y}) - mover.size);
    const auto command = stepAside(state, motion, room, {mover}, robotShape(), options);
    motion = next(motion, command.value_or(DriveCommand{}), state.speed, kAsideStep, options);
    state.speed = motion.speed;
    state.pose =
        state.pose + TPose2D(motion.speed * kAsideStep, 0, motion.command().turn * kAsideStep);
    outcome.way += std::abs(motion.speed) * kAsideStep;
    mover.place += kAsideStep * mover.velocity;
  }
  return outcome;
}

}  // namespace

TEST(StepAside, GetsOutOfTheWayOfWhoeverWalksIntoItWhereThereIsRoom) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), speed(0.5, 1.3), off(-0.3, 0.3);
  int touched = 0;
  for (int i = 0; i < 60; ++i) {
    const double from = angle(random);
    const Vector2d towards(-std::cos(from), -std::sin(from)), side(towards.y(), -towards.x());
    const Vector2d aim = Vector2d(0.15, 0) + off(random) * side;
    const Encounter outcome =
        encounterWith(walkerAt(aim - 6 * towards, speed(random) * towards), {});
    touched += outcome.leastDistance <= 0;
    EXPECT_GT(outcome.way, 0.1) << i;
  }
  EXPECT_LE(touched, 1);
}

TEST(StepAside, StaysWhereNobodyWalksIntoIt) {
  EXPECT_EQ(encounterWith(walkerAt({6, 1.5}, {-1.2, 0}), {}).way, 0) << "he passes";
  EXPECT_EQ(encounterWith(walkerAt({1.5, 0}, {0, 0}), {}).way, 0) << "he stands";
  EXPECT_EQ(encounterWith(walkerAt({2, 0}, {1, 0}), {}).way, 0) << "he walks away";
}

TEST(StepAside, DrivesIntoNothingWhereThereIsNoRoom) {
  std::vector<Vector2d> walls;
  for (double x = -0.6; x < 0.91; x += 0.1)
    for (const double y : {-0.6, 0.6}) walls.emplace_back(x, y);
  for (double y = -0.6; y < 0.61; y += 0.1) walls.emplace_back(-0.6, y);
  const Encounter outcome = encounterWith(walkerAt({6, 0}, {-1.2, 0}), walls);
  EXPECT_GE(outcome.leastRoom, DriveOptions().margin - 0.02);
}
