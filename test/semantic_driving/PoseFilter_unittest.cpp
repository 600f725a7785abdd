#include "simulated_drive/PoseFilter.h"

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

/** Ten meters straight ahead. */
TPose2D driven(const PoseOptions& options, std::uint64_t seed) {
  PoseFilter filter({0, 0, 0}, options, seed);
  for (int i = 0; i < 100; ++i) filter.move({0.1, 0, 0});
  return filter.pose();
}

/** A yard with walls, of which the vehicle in (0, 0) sees the voxels' centers. */
class Yard : public testing::Test {
 protected:
  Yard() {
    for (const double z : {0.5, 0.7, 0.9})
      for (int i = -20; i < 20; ++i) {
        const double along = (i + 0.5) * 0.2;
        for (const double side : {-3.9, 3.9}) {
          add({along, side, z});
          add({side, along, z});
        }
      }
    semantic_octree::InsertionOptions options;
    for (int i = 0; i < 5; ++i) map.insert(seen[0].cloud, T_map_sensor(), options);
  }
  void add(const Eigen::Vector3d& point) {
    seen[0].cloud.points.push_back((point - T_map_sensor().translation()).cast<float>());
    seen[0].cloud.classes.push_back(PaintedWorld::Wall);
  }
  static Eigen::Isometry3d T_map_sensor() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << 0.05, 0.05, 0.7;
    return T;
  }
  /** A filter that believes to be in (0, 0), after a way there and back that it measured badly. */
  PoseFilter astray(std::uint64_t seed) const {
    PoseFilter filter({0, 0, 0}, noisy(), seed);
    for (int i = 0; i < 10; ++i) filter.move({0.1, 0, 0});
    for (int i = 0; i < 10; ++i) filter.move({-0.1, 0, 0});
    return filter;
  }

  semantic_octree::SemanticOcTree map{0.2, PaintedWorld::classTable()};
  std::vector<Observation> seen = [] {
    Observation o;
    o.T_robot_sensor = T_map_sensor();
    return std::vector<Observation>{o};
  }();
};

double error(const PoseFilter& filter) { return std::hypot(filter.pose().x, filter.pose().y); }

}  // namespace

TEST(PoseFilter, WithoutNoiseIsExact) {
  const TPose2D pose = driven({}, 1);
  EXPECT_NEAR(pose.x, 10, 1e-9);
  EXPECT_EQ(pose.y, 0);
  EXPECT_EQ(pose.phi, 0);
}

TEST(PoseFilter, OdometryErsByTheSquareRootOfTheWay) {
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

TEST_F(Yard, CorrectsWhatOdometryMeasuredBadly) {
  double before = 0, after = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    PoseFilter filter = astray(seed);
    before += error(filter);
    for (int i = 0; i < 5; ++i) filter.correct(map, seen, Eigen::Isometry3d::Identity());
    after += error(filter);
    EXPECT_LT(error(filter), 0.1) << seed;  // half a voxel
  }
  EXPECT_LT(after, before / 3);
}

TEST_F(Yard, WhereTheMapTellsNothingNothingChanges) {
  PoseFilter filter = astray(1);
  const TPose2D before = filter.pose();
  const semantic_octree::SemanticOcTree empty(0.2, PaintedWorld::classTable());
  filter.correct(empty, seen, Eigen::Isometry3d::Identity());
  EXPECT_EQ(filter.pose(), before);
}

TEST_F(Yard, OdometryIsNotCorrected) {
  PoseFilter filter = astray(1);
  const TPose2D before = filter.odometry();
  filter.correct(map, seen, Eigen::Isometry3d::Identity());
  EXPECT_EQ(filter.odometry(), before);
  EXPECT_NE(filter.pose(), before);
}
