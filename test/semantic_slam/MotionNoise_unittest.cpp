#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
