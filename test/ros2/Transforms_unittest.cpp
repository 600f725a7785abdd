#include "Transforms.h"

#include <gtest/gtest.h>

#include "TemporaryFolder.h"

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using ros2::Stamp;
using semantic_map_ros2::Transforms;

namespace {

constexpr Stamp kSecond = 1'000'000'000;

std::string add(Transforms& all, const std::string& parent, const std::string& child, Stamp stamp,
                const Isometry3d& T, bool isStatic = false) {
  return all.add(
      {ros2::headerOf(stamp, parent), ros2::textOf(child), semantic_map_ros2::transformOf(T)},
      isStatic);
}

Isometry3d at(double x, double turn = 0) {
  return Translation3d(x, 0, 0) * AngleAxisd(turn, Vector3d::UnitZ());
}

}  // namespace

TEST(RosTransforms, leadFromFrameToFrameInBetweenStamps) {
  Transforms all;
  add(all, "map", "odom", 0, at(10), true);
  add(all, "odom", "base", 5 * kSecond, at(0));
  add(all, "odom", "base", 6 * kSecond, at(2, 1));
  add(all, "base", "lidar", 0, at(0.5), true);
  const auto T = all.find("map", "lidar", 5 * kSecond + kSecond / 2).T_target_source;
  ASSERT_TRUE(T);
  EXPECT_TRUE(T->isApprox(at(11, 0.5) * at(0.5), 1e-12));
  const auto back = all.find("lidar", "map", 5 * kSecond + kSecond / 2).T_target_source;
  EXPECT_TRUE((*T * *back).isApprox(Isometry3d::Identity(), 1e-12));
  EXPECT_EQ(all.latest("map", "lidar"), 6 * kSecond);
  EXPECT_FALSE(all.latest("map", "odom"));
}

TEST(RosTransforms, sayWhetherToWait) {
  Transforms all;
  EXPECT_TRUE(
      contains(all.find("map", "base", 0).problem, "no transform connects 'map' and 'base'"));
  EXPECT_FALSE(all.find("map", "base", 0).isLost);
  add(all, "map", "base", 5 * kSecond, at(0));
  EXPECT_TRUE(all.find("map", "base", 5 * kSecond).T_target_source);
  EXPECT_FALSE(all.find("map", "base", 6 * kSecond).isLost);
  EXPECT_FALSE(all.find("map", "base", 6 * kSecond).T_target_source);
  EXPECT_TRUE(all.find("map", "base", 4 * kSecond).isLost);
}

TEST(RosTransforms, forgetWhatIsOldAndWhatWasBeforeStampsWentBack) {
  Transforms all;
  for (int s = 0; s < 100; ++s) add(all, "map", "base", s * kSecond, at(s));
  EXPECT_TRUE(all.find("map", "base", 60 * kSecond).isLost);
  EXPECT_TRUE(all.find("map", "base", 80 * kSecond).T_target_source);
  EXPECT_TRUE(contains(add(all, "map", "base", 3 * kSecond, at(0)), "went back"));
  EXPECT_FALSE(all.find("map", "base", 80 * kSecond).T_target_source);
  EXPECT_TRUE(all.find("map", "base", 3 * kSecond).T_target_source);
}

TEST(RosTransforms, refuseWhatIsNone) {
  Transforms all;
  add(all, "a", "b", 0, at(0));
  EXPECT_TRUE(contains(add(all, "b", "a", 0, at(0)), "ring"));
  EXPECT_TRUE(contains(add(all, "c", "c", 0, at(0)), "no two frames"));
  EXPECT_TRUE(contains(add(all, "c", "d", 0, at(NAN)), "no pose"));
  const std::string parent = "c", child = "d";
  EXPECT_TRUE(
      contains(all.add({ros2::headerOf(0, parent), ros2::textOf(child), {}}, false), "no pose"));
}

TEST(RosTransforms, odometersCountWhereTfDoesNotTell) {
  Transforms all;
  const std::string odom = "odom", base = "base";
  ros2::Odometry message{};
  message.header = ros2::headerOf(0, odom);
  message.child_frame_id = ros2::textOf(base);
  message.pose.pose.orientation.w = 1;
  message.pose.pose.position.x = 3;
  all.add(message);
  EXPECT_EQ(all.find("odom", "base", 0).T_target_source->translation().x(), 3);
  add(all, "footprint", "base", 0, at(1), true);
  all.add(message);
  EXPECT_FALSE(all.find("odom", "base", 0).T_target_source);
  EXPECT_TRUE(all.find("footprint", "base", 0).T_target_source);
}
