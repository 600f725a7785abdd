#include "simulated_drive/Localization.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../semantic_planning/PaintedWorld.h"

using mrpt::math::TPose2D;
using namespace simulated_drive;

namespace {

PoseOptions noisy() {
  PoseOptions options;
  options.odometryNoise = 0.1;
  options.turnNoise = 3;
  return options;
}

Localization localization(const PoseOptions& options, std::uint64_t seed,
                          std::vector<bool> isMover = {}) {
  return Localization({0, 0, 0}, options, {}, std::move(isMover), seed);
}

/** Ten meters straight ahead. */
TPose2D driven(const PoseOptions& options, std::uint64_t seed) {
  Localization robot = localization(options, seed);
  for (int i = 0; i < 100; ++i) robot.move({0.1, 0, 0});
  return robot.pose();
}

/** What is seen of a yard of 12 m x 10 m with walls. \param moverAt a row of things of another
 * class ahead of the robot, m */
std::vector<Observation> yardFrom(const TPose2D& pose, double moverAt = 0) {
  Observation o;
  const auto add = [&](double x, double y, double z, semantic_types::ClassId id) {
    const auto p = pose.inverseComposePoint({x, y});
    o.cloud.points.emplace_back(p.x, p.y, z);
    o.cloud.classes.push_back(id);
  };
  for (double z = 0.1; z < 2; z += 0.2) {
    for (double x = -6; x < 6; x += 0.1)
      for (const double y : {-5., 5.}) add(x, y, z, PaintedWorld::Wall);
    for (double y = -5; y < 5; y += 0.1)
      for (const double x : {-6., 6.}) add(x, y, z, PaintedWorld::Wall);
    for (double y = -3; moverAt > 0 && y < 3; y += 0.1)
      add(pose.x + moverAt, y, z, PaintedWorld::Road);
  }
  return {o};
}

double errorOf(const Localization& robot, const TPose2D& truth) {
  return std::hypot(robot.pose().x - truth.x, robot.pose().y - truth.y);
}

/** Three meters ahead, with scans each 0.5 m. \param moverAt see yardFrom()
 * \return the error at the end; beside it, that of odometry. */
std::pair<double, double> errorInYard(Localization& robot, double moverAt = 0) {
  TPose2D truth(-1.5, 0, 0);
  for (int i = 0; i <= 30; ++i) {
    if (i % 5 == 0) robot.correct(yardFrom(truth, moverAt), Eigen::Isometry3d::Identity());
    if (i == 30) break;
    const TPose2D motion(0.1, 0, 0.01);
    robot.move(motion);
    truth = truth + motion;
  }
  return {errorOf(robot, truth),
          std::hypot(robot.odometry().x - truth.x, robot.odometry().y - truth.y)};
}

}  // namespace

TEST(Localization, WithoutNoiseIsExact) {
  const TPose2D pose = driven({}, 1);
  EXPECT_NEAR(pose.x, 10, 1e-9);
  EXPECT_EQ(pose.y, 0);
  EXPECT_EQ(pose.phi, 0);
}

TEST(Localization, OdometryErsByTheSquareRootOfTheWay) {
  PoseOptions along = noisy(), turning = noisy();
  along.turnNoise = 0;
  turning.odometryNoise = 0;
  constexpr int kDrives = 2000;
  double way = 0, turn = 0;
  for (int seed = 0; seed < kDrives; ++seed) {
    way += std::pow(driven(along, seed).x - 10, 2) / kDrives;
    turn += std::pow(driven(turning, seed).phi * 180 / M_PI, 2) / kDrives;
  }
  // After 10 m; the standard error of a standard deviation is 1 / sqrt(2 * kDrives) of it.
  EXPECT_NEAR(std::sqrt(way), 0.1 * std::sqrt(10.0), 0.1 * std::sqrt(10.0) * 0.07);
  EXPECT_NEAR(std::sqrt(turn), 3 * std::sqrt(10.0), 3 * std::sqrt(10.0) * 0.07);
}

TEST(Localization, ScansCorrectWhatOdometryMeasuredBadly) {
  double odometry = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Localization robot({-1.5, 0, 0}, noisy(), {}, {}, seed);
    const auto [error, withoutScans] = errorInYard(robot);
    EXPECT_LT(error, 0.03) << seed;
    odometry += withoutScans / 10;
    EXPECT_EQ(robot.slam().numLost(), 0u);
    EXPECT_NE(robot.odometry(), robot.pose());
  }
  EXPECT_GT(odometry, 0.1);
}

TEST(Localization, WhatMovesIsNoEvidence) {
  std::vector<bool> isMover(256, false);
  isMover[PaintedWorld::Road] = true;
  Localization still({-1.5, 0, 0}, noisy(), {}, isMover, 1);
  Localization walking({-1.5, 0, 0}, noisy(), {}, isMover, 1);
  EXPECT_EQ(errorInYard(still).first, errorInYard(walking, 3).first);
}

TEST(Localization, NothingSeenIsOdometry) {
  Localization robot = localization(noisy(), 1);
  for (int i = 0; i < 40; ++i) {
    robot.move({0.1, 0, 0});
    if (i % 5 == 0) robot.correct({}, Eigen::Isometry3d::Identity());
  }
  EXPECT_NEAR(robot.pose().x, robot.odometry().x, 1e-9 + 0.1);
  EXPECT_GT(robot.slam().numLost(), 0u);
}
