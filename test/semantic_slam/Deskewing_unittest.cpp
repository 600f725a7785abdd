#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <semantic_slam/Mapper.h>

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <vector>

#include "Recordings.h"

using namespace recordings;
using semantic_octree::SemanticOcTree;
using semantic_slam::Mapper;
using semantic_slam::SensorScan;

namespace {

/** A LiDAR on a robot that moves at constant velocity, and what it saw. */
struct Sweep {
  std::mt19937 random;
  Vector6 velocity;
  SensorScan straight, skewed;

  explicit Sweep(unsigned seed, double slowdown = 1) : random(seed) {
    for (int i = 0; i < 6; ++i) velocity[i] = slowdown * (i < 3 ? 20 : 2) * uniform();
    Vector6 mount;
    for (int i = 0; i < 6; ++i) mount[i] = 2 * uniform();
    skewed.T_robot_sensor = straight.T_robot_sensor = poseOf(mount);
    for (int i = 0; i < 100; ++i) {
      skewed.times.push_back(i % 10 == 0 ? 0.f : static_cast<float>(0.1 * uniform()));
      const Eigen::Vector3d p(20 * uniform(), 20 * uniform(), 3 * uniform());
      straight.cloud.points.push_back(p.cast<float>());
      const Eigen::Isometry3d T = moved(skewed.times.back()) * skewed.T_robot_sensor;
      skewed.cloud.points.push_back((T.inverse() * (straight.T_robot_sensor * p)).cast<float>());
    }
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  /** In small steps. */
  Eigen::Isometry3d moved(double seconds) const {
    constexpr int kSteps = 500;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = 0; i < kSteps; ++i) T = T * poseOf(seconds / kSteps * velocity);
    return T;
  }
};

}  // namespace

RC_GTEST_PROP(Deskewing, byTheTrueVelocityAllIsSeenAtOnce, ()) {
  const Sweep sweep(*rc::gen::arbitrary<unsigned>());
  const SensorScan scan = deskewed(sweep.skewed, sweep.velocity);
  RC_ASSERT(scan.times.empty());
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    RC_ASSERT((scan.cloud.points[i] - sweep.straight.cloud.points[i]).norm() < 2e-3f);
}

RC_GTEST_PROP(Deskewing, changesNoBitOfWhatStandsOrWasTakenAtTheTimeOfTheScan, ()) {
  const Sweep sweep(*rc::gen::arbitrary<unsigned>());
  RC_ASSERT(deskewed(sweep.skewed, Vector6::Zero()).cloud.points == sweep.skewed.cloud.points);
  const auto points = deskewed(sweep.skewed, sweep.velocity).cloud.points;
  for (std::size_t i = 0; i < points.size(); i += 10)
    RC_ASSERT(points[i] == sweep.skewed.cloud.points[i]);
}

RC_GTEST_PROP(Deskewing, velocityIsWhatLedFromPoseToPose, ()) {
  const Sweep sweep(*rc::gen::arbitrary<unsigned>());
  for (const double seconds : {1e-3, 0.1, 0.5})
    RC_ASSERT(
        velocityOf(movedFor(seconds, sweep.velocity), seconds).isApprox(sweep.velocity, 1e-8));
}

TEST(Deskewing, needsATimeForEachPoint) {
  SensorScan scan;
  scan.cloud.points = {{1, 2, 3}, {4, 5, 6}};
  scan.times = {0.1f};
  EXPECT_THROW(deskewed(scan, Vector6::Ones()), std::invalid_argument);
}

TEST(Deskewing, ofASecondSensorSoonAfterIsByTheVelocityOfBoth) {
  const Sweep sweep(1, 0.1);
  const Eigen::Isometry3d T = movedFor(0.5, sweep.velocity);
  for (const double seconds : {7.5, 7.501}) {
    const auto mapOf = [&](const SensorScan& second) {
      SemanticOcTree map(0.2, synthetic_world::classTable());
      Mapper mapper(map, {});
      mapper.insert(SensorScan{}, Eigen::Isometry3d::Identity(), 7);
      mapper.insert(SensorScan{}, T, 7.5);
      mapper.insert(second, T * Eigen::Translation3d(0.01, 0, 0), seconds);  // odometry's noise
      return map;
    };
    EXPECT_TRUE(mapOf(sweep.skewed) == mapOf(deskewed(sweep.skewed, sweep.velocity))) << seconds;
  }
}

namespace {

struct Trial {
  bool isSkewed = true, hasTimes = true, hasOdometry = false;
  int sensors = 1;  ///< that share the beams, a millisecond apart
};

SensorScan partOf(const SensorScan& scan, int part, int parts) {
  SensorScan result{{}, scan.T_robot_sensor};
  for (std::size_t i = part; i < scan.cloud.size(); i += parts) {
    result.cloud.points.push_back(scan.cloud.points[i]);
    result.cloud.classes.push_back(scan.cloud.classes[i]);
    if (!scan.times.empty()) result.times.push_back(scan.times[i]);
  }
  return result;
}

/** The largest error (m) on 25 m through a village, at 10 m/s with ten turns a second. */
double errorOf(const Trial& trial) {
  constexpr double kTurn = 0.1, kSpeed = 10;  // s, m/s
  const synthetic_world::Scene place = synthetic_world::makeScene("village", 2);
  synthetic_world::LidarOptions lidar;
  lidar.columns = 360;
  Slam slam({});
  double largest = 0;
  for (std::uint64_t i = 0; i < 25; ++i) {
    for (int part = 0; part < trial.sensors; ++part) {
      const double time = kTurn * static_cast<double>(i) + 1e-3 * part;
      const Eigen::Isometry3d T = place.T_world_robot(kSpeed * time);
      const auto path = [&](double share) {
        return place.T_world_robot(kSpeed * (time + (trial.isSkewed ? share * kTurn : 0))) *
               kRobotLidar;
      };
      SensorScan scan{scanLidar(place.world, path, lidar, {1, i}), kRobotLidar};
      if (trial.hasTimes) scan.times = synthetic_world::sharesOfTurn(scan.cloud);
      for (float& t : scan.times) t *= static_cast<float>(kTurn);
      const auto added = slam.add(partOf(scan, part, trial.sensors),
                                  trial.hasOdometry ? std::make_optional(T) : std::nullopt, time);
      const Eigen::Isometry3d T_begin =
          trial.hasOdometry ? Eigen::Isometry3d::Identity() : place.T_world_robot(0);
      const Eigen::Isometry3d found =
          T_begin * slam.poses()[added.keyframe] * added.T_keyframe_robot;
      largest = std::max(largest, (found.translation() - T.translation()).norm());
    }
  }
  return largest;
}

}  // namespace

TEST(Deskewing, ofSlamMakesUpForTheTimeThatScansTake) {
  for (const bool hasOdometry : {false, true}) {
    const double still = errorOf({false, false, hasOdometry});
    EXPECT_GT(errorOf({true, false, hasOdometry}), 0.1) << hasOdometry;
    EXPECT_LT(errorOf({true, true, hasOdometry}), still + 0.02) << hasOdometry;
    EXPECT_LT(errorOf({true, true, hasOdometry, 3}), still + 0.03) << hasOdometry;
  }
}
