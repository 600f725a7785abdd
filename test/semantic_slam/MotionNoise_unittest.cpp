#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "MotionNoise.h"

using namespace semantic_slam;

namespace {

/** After many steps of a robot whose odometry errs so many times as much as is assumed of bad
 * wheels. \param seen information of a registration, times that of the prediction at first
 * \return mean factors, of the way and of turns */
std::pair<double, double> learned(double wayFactor, double turnFactor, double seen) {
  constexpr int kSteps = 6000, kFirst = 1000;
  const Eigen::Isometry3d T_step(Eigen::Translation3d(0.5, 0, 0));
  MotionNoise noise;
  const Matrix6 assumed = noise.information(T_step);
  const double way = wayFactor / std::sqrt(assumed(0, 0)),
               turn = turnFactor / std::sqrt(assumed(5, 5));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double ways = 0, turns = 0;
  for (int i = 0; i < kSteps; ++i) {
    Vector6 truth = Vector6::Zero(), measured;
    truth << way * normal(random), way * normal(random), 0, 0, 0, turn * normal(random);
    const Matrix6 own = seen * assumed;
    for (int k = 0; k < 6; ++k) measured[k] = truth[k] + normal(random) / std::sqrt(own(k, k));
    const Matrix6 both = own + noise.information(T_step);
    noise.note(T_step, poseOf(both.inverse() * own * measured), both);
    if (i < kFirst) continue;
    ways += noise.wayFactor() * noise.wayFactor() / (kSteps - kFirst);
    turns += noise.turnFactor() * noise.turnFactor() / (kSteps - kFirst);
  }
  return {std::sqrt(ways), std::sqrt(turns)};
}

}  // namespace

TEST(MotionNoise, isThatOfTheWheelsHoweverWellScansSee) {
  for (const double seen : {3., 1000.})
    for (const auto& [way, turn] : {std::pair(1., 1.), {0.3, 1.5}, {2., 0.3}}) {
      const auto [byWay, byTurn] = learned(way, turn, seen);
      EXPECT_NEAR(byWay / way, 1, 0.15) << way << " seen " << seen;
      EXPECT_NEAR(byTurn / turn, 1, 0.15) << turn << " seen " << seen;
    }
}

TEST(MotionNoise, scansThatSayNothingTeachNothing) {
  const auto [way, turn] = learned(3, 3, 1e-6);
  EXPECT_NEAR(way, 1, 0.01);
  EXPECT_NEAR(turn, 1, 0.01);
}

namespace {

/** After a drive with corners, of wheels that say too much way and too much of turns, and that turn
 * a robot which goes straight. \param seen information of registrations, times that of the
 * prediction at first */
MotionNoise driven(double way, double turn, double perMeter, double seen) {
  MotionNoise noise;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    Vector6 truth = Vector6::Zero(), said = Vector6::Zero();
    truth << 0.3, 0, 0, 0, 0, i % 40 < 6 ? 0.25 : 0.0;  // 86 degrees each 12 m
    said << way * 0.3 + 0.005 * normal(random), 0, 0, 0, 0,
        turn * truth[5] + perMeter * 0.3 + 0.005 * normal(random);
    const Eigen::Isometry3d T_odometry = poseOf(said), T_step = noise.calibrated(T_odometry);
    const Matrix6 own = seen * MotionNoise().information(T_step),
                  both = own + noise.information(T_step);
    const Eigen::Isometry3d T_off =
        poseOf(both.inverse() * own * vectorOf(T_step.inverse() * poseOf(truth)));
    noise.calibrate(T_odometry, T_step, T_off, both);
    noise.note(T_step, T_off, both);
  }
  return noise;
}

}  // namespace

TEST(MotionNoise, whatWheelsDoWrongAtEachStepIsTakenOff) {
  for (const double seen : {1., 100.})
    for (const auto& [way, turn, perMeter] :
         {std::tuple(1., 1., 0.), {0.5, 1., 0.}, {1.02, 0.8, 0.01}, {0.98, 1.25, -0.01}}) {
      const MotionNoise noise = driven(way, turn, perMeter, seen);
      Vector6 said = Vector6::Zero();
      said << way * 0.3, 0, 0, 0, 0, turn * 0.25 + perMeter * 0.3;
      const Vector6 found = vectorOf(noise.calibrated(poseOf(said)));
      EXPECT_NEAR(found[0], 0.3, 0.004) << way << " seen " << seen;
      EXPECT_NEAR(found[5], 0.25, 0.006) << turn << " seen " << seen;
    }
}

TEST(MotionNoise, scansThatSayNothingDoNotCalibrate) {
  const MotionNoise noise = driven(0.5, 0.8, 0.02, 1e-6);
  const Eigen::Isometry3d T_odometry(Eigen::Translation3d(0.3, 0, 0));
  EXPECT_LT(vectorOf(T_odometry.inverse() * noise.calibrated(T_odometry)).norm(), 0.01);
}

TEST(MotionNoise, noiseOfAStraightWayIsNoTurn) {
  MotionNoise noise;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    Vector6 truth = Vector6::Zero(), said;
    truth[0] = 0.15;
    said << 0.15, 0, 0, 0, 0, 0.004 * normal(random);
    const Eigen::Isometry3d T_odometry = poseOf(said), T_step = noise.calibrated(T_odometry);
    const Matrix6 both = 100 * noise.information(T_step);
    const Eigen::Isometry3d T_off = T_step.inverse() * poseOf(truth);
    noise.calibrate(T_odometry, T_step, T_off, both);
    noise.note(T_step, T_off, both);
  }
  Vector6 corner = Vector6::Zero();
  corner << 0.15, 0, 0, 0, 0, 0.25;
  EXPECT_NEAR(vectorOf(noise.calibrated(poseOf(corner)))[5], 0.25, 0.025);
}
