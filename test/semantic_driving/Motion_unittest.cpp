#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <semantic_driving/Motion.h>

#include <cmath>

using namespace semantic_driving;

namespace {

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
