#include "point_fields/Frames.h"

#include <gtest/gtest.h>

#include "TemporaryFolder.h"

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using point_fields::Frames;
using point_fields::Stamp;
using Kind = Frames::Kind;

namespace {

constexpr Stamp kSecond = 1'000'000'000;

std::string add(Frames& all, const std::string& parent, const std::string& child, Stamp stamp,
                const Isometry3d& T, Kind kind = Kind::Moving) {
  return all.add({stamp, parent, child, T.translation(), Eigen::Quaterniond(T.linear())}, kind);
}

Isometry3d at(double x, double turn = 0) {
  return Translation3d(x, 0, 0) * AngleAxisd(turn, Vector3d::UnitZ());
}

}  // namespace

TEST(Frames, leadFromFrameToFrameInBetweenStamps) {
  Frames all(true);
  add(all, "map", "odom", 0, at(10), Kind::Static);
  add(all, "odom", "base", 5 * kSecond, at(0));
  add(all, "odom", "base", 6 * kSecond, at(2, 1));
  add(all, "base", "lidar", 0, at(0.5), Kind::Static);
  const auto T = all.find("map", "lidar", 5 * kSecond + kSecond / 2).T_target_source;
  ASSERT_TRUE(T);
  EXPECT_TRUE(T->isApprox(at(11, 0.5) * at(0.5), 1e-12));
  const auto back = all.find("lidar", "map", 5 * kSecond + kSecond / 2).T_target_source;
  EXPECT_TRUE((*T * *back).isApprox(Isometry3d::Identity(), 1e-12));
  EXPECT_EQ(all.latest("map", "lidar"), 6 * kSecond);
  EXPECT_FALSE(all.latest("map", "odom"));
}

TEST(Frames, sayWhetherToWait) {
  Frames all(true);
  EXPECT_TRUE(
      contains(all.find("map", "base", 0).problem, "no transform connects 'map' and 'base'"));
  EXPECT_FALSE(all.find("map", "base", 0).isLost);
  add(all, "map", "base", 5 * kSecond, at(0));
  EXPECT_TRUE(all.find("map", "base", 5 * kSecond).T_target_source);
  EXPECT_FALSE(all.find("map", "base", 6 * kSecond).isLost);
  EXPECT_FALSE(all.find("map", "base", 6 * kSecond).T_target_source);
  EXPECT_TRUE(all.find("map", "base", 4 * kSecond).isLost);
}

TEST(Frames, forgetWhatIsOldAndWhatWasBeforeStampsWentBack) {
  Frames all(true);
  for (int s = 0; s < 100; ++s) add(all, "map", "base", s * kSecond, at(s));
  EXPECT_TRUE(all.find("map", "base", 60 * kSecond).isLost);
  EXPECT_TRUE(all.find("map", "base", 80 * kSecond).T_target_source);
  EXPECT_TRUE(contains(add(all, "map", "base", 3 * kSecond, at(0)), "went back"));
  EXPECT_FALSE(all.find("map", "base", 80 * kSecond).T_target_source);
  EXPECT_TRUE(all.find("map", "base", 3 * kSecond).T_target_source);
}

TEST(Frames, refuseWhatIsNone) {
  Frames all(true);
  add(all, "a", "b", 0, at(0));
  EXPECT_TRUE(contains(add(all, "b", "a", 0, at(0)), "ring"));
  EXPECT_TRUE(contains(add(all, "c", "c", 0, at(0)), "no two frames"));
  EXPECT_TRUE(contains(add(all, "c", "d", 0, at(NAN)), "no pose"));
  EXPECT_TRUE(contains(all.add({0, "c", "d", {0, 0, 0}, {0, 0, 0, 0}}, Kind::Moving), "no pose"));
}

TEST(Frames, odometersCountWhereTfDoesNotTell) {
  Frames all(true);
  add(all, "odom", "base", 0, at(3), Kind::Odometers);
  EXPECT_EQ(all.find("odom", "base", 0).T_target_source->translation().x(), 3);
  add(all, "footprint", "base", 0, at(1), Kind::Static);
  add(all, "odom", "base", 0, at(3), Kind::Odometers);
  EXPECT_FALSE(all.find("odom", "base", 0).T_target_source);
  EXPECT_TRUE(all.find("footprint", "base", 0).T_target_source);
}

TEST(Frames, ofABagStayForAsLongAsItIs) {
  Frames all(false);
  for (int s = 0; s < 100; ++s) add(all, "/odom", "/base", s * kSecond, at(s));
  add(all, "map", "odom", 0, at(0), Kind::Static);
  add(all, "base", "lidar", 0, at(0), Kind::Static);
  EXPECT_TRUE(all.find("odom", "base", kSecond).T_target_source->isApprox(at(1)));
  EXPECT_TRUE(contains(add(all, "other", "base", kSecond, at(7)), "another parent"));
  EXPECT_TRUE(all.find("odom", "base", kSecond).T_target_source->isApprox(at(1)));
  EXPECT_EQ(all.robotOf("/lidar"), "base");
  EXPECT_EQ(all.rootOf("lidar"), "map");
  EXPECT_EQ(all.robotOf("map"), "");
}
