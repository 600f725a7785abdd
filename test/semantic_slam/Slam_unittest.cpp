#include <gtest/gtest.h>
#include <semantic_slam/Slam.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "Recordings.h"

using namespace recordings;

TEST(Slam, closesTheLoopOfAVillageWithoutLabels) {
  Recording r = recordingOf("village", 2, lidarOf(0));
  SlamOptions options;
  options.useClasses = false;
  Slam slam(options);
  for (LabeledCloud& cloud : r.clouds) cloud.classes.clear();
  addAll(slam, r, kRobotLidar);
  EXPECT_GT(slam.report().loops, 0u);
  EXPECT_LT(errorsOf(slam.poses(), r).last, 0.1);
}

TEST(Slam, closesTheLoopOfASingleCamera) {
  const Recording r = recordingOf("village", 1, cameraOf(20));
  for (const bool useClasses : {false, true}) {
    SlamOptions options;
    options.useClasses = useClasses;
    Slam slam(options);
    addAll(slam, r, kRobotCamera);
    EXPECT_EQ(slam.report().lost, 0u) << useClasses;
    EXPECT_LT(errorsOf(slam.poses(), r).last, 0.1) << useClasses;
    EXPECT_LT(errorsOf(slam.poses(), r).rootMeanSquare, 0.12) << useClasses;
  }
}

TEST(Slam, aLoopClosesWhenTheNextOneSaysTheSame) {
  // 10 m of range: back at the start the robot is 7 m off, and sees things that fit elsewhere.
  const Recording r = recordingOf("village", 1, cameraOf(10));
  Slam slam({});
  addAll(slam, r, kRobotCamera);
  EXPECT_GT(slam.report().loops, 0u);
  for (const PoseEdge& edge : slam.edges()) {
    const Eigen::Isometry3d T_a_b = r.truth[edge.a].inverse() * r.truth[edge.b];
    EXPECT_LT((edge.T_a_b.translation() - T_a_b.translation()).norm(), 0.1) << edge.b;
  }
  EXPECT_LT(errorsOf(slam.poses(), r).last, 0.3);
}

/** Else the next loop would move poses back to where they were before the loops that went. */
TEST(Slam, stepsSayWhatPosesDoAfterKeyframesWithTheirLoopsWent) {
  const Recording r = recordingOf("village", 1, cameraOf(10));
  Slam slam({});
  addAll(slam, r, kRobotCamera);
  std::vector<Eigen::Isometry3d> kept;
  std::vector<std::size_t> gone;
  for (std::size_t k = 0; k < slam.poses().size(); ++k) {
    const bool hasLoop =
        std::any_of(slam.edges().begin(), slam.edges().end(),
                    [k](const PoseEdge& e) { return e.isDoubtful && (e.a == k || e.b == k); });
    if (hasLoop && k > 0 && k + 20 < slam.poses().size())
      gone.push_back(k);
    else
      kept.push_back(slam.poses()[k]);
  }
  ASSERT_GT(gone.size(), 0u);
  slam.forget(gone);
  ASSERT_EQ(slam.poses().size(), kept.size());
  std::size_t steps = 0;
  for (const PoseEdge& edge : slam.edges()) {
    ASSERT_LT(edge.b, kept.size());
    steps += !edge.isDoubtful;
    const Eigen::Isometry3d T_a_b = kept[edge.a].inverse() * kept[edge.b];
    EXPECT_TRUE(edge.isDoubtful || edge.T_a_b.isApprox(T_a_b, 1e-9)) << edge.b;
  }
  EXPECT_EQ(steps, kept.size() - 1);
}

TEST(Slam, findsItsWayWithoutOdometry) {
  const Recording r = recordingOf("village", 2, lidarOf(0), 150);
  Slam slam({});
  for (const LabeledCloud& cloud : r.clouds) slam.add(cloud, kRobotLidar, std::nullopt);
  slam.finish();
  EXPECT_EQ(slam.report().lost, 0u);
  ASSERT_EQ(slam.poses().size(), r.truth.size());
  for (std::size_t k = 0; k < r.truth.size(); ++k) {
    const Eigen::Isometry3d T = r.truth[0] * slam.poses()[k];
    EXPECT_LT((T.translation() - r.truth[k].translation()).norm(), 0.3) << k;
  }
}

namespace {

/** The heading that odometry has is off by 2 or 3 degrees each meter, and the way by 5 %;
 * height and tilt are right. */
std::vector<Eigen::Isometry3d> levelOdometryOf(const Recording& r) {
  const auto planar = [](const Eigen::Isometry3d& T) {
    Eigen::Isometry3d flat(Eigen::Translation3d(T.translation().x(), T.translation().y(), 0));
    flat.rotate(Eigen::AngleAxisd(std::atan2(T(1, 0), T(0, 0)), Eigen::Vector3d::UnitZ()));
    return flat;
  };
  std::vector<Eigen::Isometry3d> odometry = {r.truth[0]};
  Eigen::Isometry3d T = planar(r.truth[0]);
  for (std::size_t i = 1; i < r.truth.size(); ++i) {
    Eigen::Isometry3d motion = planar(r.truth[i - 1]).inverse() * planar(r.truth[i]);
    motion.translation() *= 1.05;
    const double turn = (i % 2 ? 3 : -2) * M_PI / 180;
    T = T * motion * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
    odometry.push_back(T * planar(r.truth[i]).inverse() * r.truth[i]);
  }
  return odometry;
}

}  // namespace

TEST(Slam, registersOnSlopesWhereHeightAndTiltAreKnown) {
  const Recording r = recordingOf("park", 1, lidarOf(0), 20);
  const auto odometry = levelOdometryOf(r);
  SlamOptions options;
  options.level = true;
  Slam slam(options);
  double steepest = 0;
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    const Slam::Added added = slam.add(r.clouds[i], kRobotLidar, odometry[i]);
    const Eigen::Isometry3d T = slam.poses()[added.keyframe] * added.T_keyframe_robot;
    const Vector6 off = vectorOf(r.truth[i].inverse() * T);
    EXPECT_LT(off.head<3>().norm(), 0.5) << i;
    EXPECT_LT(off.tail<3>().norm(), 3 * M_PI / 180) << i;
    EXPECT_NEAR(T.translation().z(), r.truth[i].translation().z(), 1e-6) << i;
    EXPECT_NEAR(T(2, 0), r.truth[i](2, 0), 1e-6) << i;
    EXPECT_NEAR(T(2, 1), r.truth[i](2, 1), 1e-6) << i;
    steepest = std::max(steepest, std::acos(T(2, 2)));
  }
  EXPECT_GT(steepest, 5 * M_PI / 180);
}

namespace {

/** A dead end: two walls and the ground, up to 15 m away, and a wall across at x = end. */
LabeledCloud deadEndSeenFrom(double x, double end, std::mt19937& random) {
  const auto between = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  LabeledCloud cloud;
  const auto add = [&](double ahead, double across, double up) {
    cloud.points.push_back(Eigen::Vector3d(ahead, across, up).cast<float>());
  };
  for (int i = 0; i < 6000; ++i) {
    const double ahead = between(-15, std::min(15., end - x)), across = between(-3, 3),
                 up = between(-1, 5);
    add(ahead, -3, up);
    add(ahead, 3, up);
    add(ahead, across, -1);
    if (end - x < 15) add(end - x, across, up);
  }
  return cloud;
}

/** Some meters through it, to x = 6 m; odometry is right. */
Slam drivenIntoDeadEnd(double end) {
  std::mt19937 random(1);
  Slam slam({});
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (; T.translation().x() < 6; T.translation().x() += 1.01)
    slam.add(deadEndSeenFrom(T.translation().x(), end, random), Eigen::Isometry3d::Identity(), T);
  EXPECT_EQ(slam.report().lost, 0u);
  return slam;
}

double alongIt(const PoseEdge& edge) { return edge.information(0, 0); }
double acrossIt(const PoseEdge& edge) { return edge.information(1, 1); }
/** Information of odometry over 1.01 m, in both directions, before anything is learned of it. */
const double kOfOdometry = 1 / std::pow(0.2 * (0.01 + 0.1 * std::sqrt(1.01)), 2);

}  // namespace

TEST(Slam, aRegistrationIsAsCertainAsItsPointsMakeIt) {
  const Slam slam = drivenIntoDeadEnd(12);
  const PoseEdge& edge = slam.edges().back();
  EXPECT_EQ(slam.report().unheld, 0);
  EXPECT_GT(alongIt(edge), 4 * kOfOdometry) << "else odometry's errors stay";
  EXPECT_GT(acrossIt(edge), 3 * alongIt(edge)) << "two long walls say more than a short one";
}

TEST(Slam, alongACorridorWithoutAnEndOdometryHolds) {
  const Slam slam = drivenIntoDeadEnd(1e9);
  const PoseEdge& edge = slam.edges().back();
  EXPECT_NEAR(slam.report().unheld, slam.report().way, 1e-9);
  EXPECT_GT(acrossIt(edge), 6 * kOfOdometry);
  EXPECT_LT(alongIt(edge), 1.5 * kOfOdometry);
  EXPECT_NEAR(edge.T_a_b.translation().x(), 1.01, 0.005);
}

TEST(Slam, scansThatFitNothingAreWhereOdometryHasThem) {
  std::mt19937 random(1);
  Slam slam({});
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 5; ++i, T.translation().x() += 2) {
    LabeledCloud noise;  // everywhere, each time elsewhere
    for (int n = 0; n < 30; ++n)
      noise.points.emplace_back(random() % 40 - 20.f, random() % 40 - 20.f, random() % 9 - 4.f);
    const Slam::Added added = slam.add(noise, Eigen::Isometry3d::Identity(), T);
    EXPECT_TRUE(added.isNew);
    EXPECT_LT((slam.poses().back().translation() - T.translation()).norm(), 1e-9);
  }
  EXPECT_EQ(slam.report().lost, 4u);
  slam.add({}, Eigen::Isometry3d::Identity(), T);  // nor does one without a point do harm
  EXPECT_EQ(slam.report().lost, 5u);
}
