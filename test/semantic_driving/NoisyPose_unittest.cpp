#include <gtest/gtest.h>
#include <map_operations/MapOperations.h>
#include <synthetic_world/Scene.h>

#include <algorithm>
#include <cmath>

#include "Plain.h"
#include "simulated_drive/DriveLoop.h"

using namespace simulated_drive;
using mrpt::math::TPose2D;

namespace {

DriveConfig noisyConfig() {
  DriveConfig config = smallConfig();
  config.pose.odometryNoise = 0.1;
  config.pose.turnNoise = 3;
  config.sensors.seed = 2;
  return config;
}

DriveRecord drive(const DriveConfig& config) {
  auto scene = synthetic_world::makeScene("village", 1);
  DriveLoop loop(config, scene.world, syntheticOrder(), {-14, -19, 10 * M_PI / 180}, {0, -17, 0},
                 {});
  return loop.run();
}

double largestError(const DriveRecord& record, TPose2D DriveRow::*pose) {
  double largest = 0;
  for (const DriveRow& row : record.rows)
    largest = std::max(largest, std::hypot((row.*pose).x - row.pose.x, (row.*pose).y - row.pose.y));
  return largest;
}

/** Ten meters straight ahead, as odometry has them. */
TPose2D tenMeters(double odometryNoise, double turnNoise, std::uint64_t seed) {
  PoseOptions options;
  options.odometryNoise = odometryNoise;
  options.turnNoise = turnNoise;
  SimulatedOdometry odometry({0, 0, 0}, options, seed);
  for (int i = 0; i < 100; ++i) odometry.move({0.1, 0, 0});
  return odometry.pose();
}

}  // namespace

TEST(SimulatedOdometry, WithoutNoiseIsExact) {
  const TPose2D pose = tenMeters(0, 0, 1);
  EXPECT_NEAR(pose.x, 10, 1e-9);
  EXPECT_EQ(pose.y, 0);
  EXPECT_EQ(pose.phi, 0);
}

TEST(SimulatedOdometry, ErsByTheSquareRootOfTheWay) {
  constexpr int kDrives = 2000;
  double way = 0, turn = 0;
  for (int seed = 0; seed < kDrives; ++seed) {
    way += std::pow(tenMeters(0.1, 0, seed).x - 10, 2) / kDrives;
    turn += std::pow(tenMeters(0, 3, seed).phi * 180 / M_PI, 2) / kDrives;
  }
  // After 10 m; the standard error of a standard deviation is 1 / sqrt(2 * kDrives) of it.
  EXPECT_NEAR(std::sqrt(way), 0.1 * std::sqrt(10.0), 0.1 * std::sqrt(10.0) * 0.07);
  EXPECT_NEAR(std::sqrt(turn), 3 * std::sqrt(10.0), 3 * std::sqrt(10.0) * 0.07);
}

TEST(NoisyPose, CorrectedBySlamLeadsToTheGoal) {
  const DriveRecord record = drive(noisyConfig());
  EXPECT_EQ(record.end, DriveEnd::Arrived) << record.reason;
  EXPECT_EQ(record.collisions, 0);
  EXPECT_LT(largestError(record, &DriveRow::believed), 0.3);
  EXPECT_LT(largestError(record, &DriveRow::believed),
            largestError(record, &DriveRow::odometry) / 2);
  const auto error = toJson(record, syntheticOrder()).at("poseError");
  EXPECT_EQ(error.at("believed").at("largest"), largestError(record, &DriveRow::believed));
  EXPECT_GT(error.at("odometry").at("mean"), error.at("believed").at("mean"));
}

TEST(NoisyPose, IsInTheFrameOfTheMapWithWhichItBegins) {
  auto scene = synthetic_world::makeScene("village", 1);
  const TPose2D start(-14, -19, 10 * M_PI / 180), goal(0, -17, 0);
  DriveConfig exact = smallConfig();
  exact.timeLimit = 6;
  DriveLoop mapping(exact, scene.world, syntheticOrder(), start, goal, {});
  mapping.run();
  const Eigen::Isometry3d T_map_world(Eigen::Translation3d(0.4, -0.2, 0));
  DriveConfig config = noisyConfig();
  config.timeLimit = 8;
  DriveLoop loop(config, scene.world, syntheticOrder(), start, goal, {},
                 std::make_unique<semantic_octree::StoredMap>(
                     semantic_octree::moved(mapping.mapper().map(), T_map_world)));
  const DriveRow last = loop.run().rows.back();
  EXPECT_NEAR(last.believed.x - last.pose.x, 0.4, 0.1);
  EXPECT_NEAR(last.believed.y - last.pose.y, -0.2, 0.1);
}

TEST(NoisyPose, IsTheSameEachTime) {
  DriveConfig config = noisyConfig();
  config.timeLimit = 5;
  const std::string first = toCsv(drive(config));
  EXPECT_EQ(first, toCsv(drive(config)));
  config.sensors.seed = 3;
  EXPECT_NE(first, toCsv(drive(config)));
}

TEST(NoisyPose, WithoutNoiseIsExact) {
  DriveConfig config = smallConfig();
  config.timeLimit = 8;
  const DriveRecord exact = drive(config);
  EXPECT_EQ(largestError(exact, &DriveRow::believed), 0);
  EXPECT_EQ(exact.times.count("localize"), 0u);
  EXPECT_FALSE(toJson(exact, syntheticOrder()).contains("poseError"));
}
