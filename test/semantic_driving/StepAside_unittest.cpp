#include "StepAside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace semantic_driving;
using Eigen::Vector2d;
using mrpt::math::TPose2D;

namespace {

constexpr double kAsideStep = 0.1;  // s

const semantic_planning::Footprint& robotShape() {
  static const semantic_planning::Footprint robot;
  return robot;
}

Mover walkerAt(const Vector2d& place, const Vector2d& velocity) {
  return {place, velocity, 0.35, 0.1};
}

/** A robot at rest that steps aside, and nothing else. */
struct Encounter {
  double leastDistance = 1e9;  ///< m to the one who walks
  double leastRoom = 1e9;      ///< m to what it must not touch
  double way = 0;              ///< m
};

Encounter encounterWith(Mover mover, const std::vector<Vector2d>& walls, double seconds = 8) {
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
