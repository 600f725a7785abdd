#include <gtest/gtest.h>

#include "RoadInGrass.h"

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

}  // namespace

TEST_F(RoadInGrass, outlivesWhatIsWrong) {
  start({"-p", "transform_timeout:=0.3"});
  // Another type on the topic of laser scans, and another peer that dies.
  {
    ros2::Node peer("peer", {});
    ros2::Publication<ros2::Twist> wrong(peer, "scan", {});
    ros2::Publication<ros2::PointCloud2> dies(peer, "points", {});
    EXPECT_TRUE(
        live->waitFor([&] { return contains(live->said(), "geometry_msgs::msg::dds_::Twist_"); }));
    live->waitFor([&] { return dies.isRead(); });
  }
  PointMessage good(scan(), "lidar", kSecond);
  const auto complaint = [&](const std::string& words,
                             const std::function<void(ros2::PointCloud2&)>& change) {
    PointMessage bad(scan(), "lidar", kSecond);
    change(bad.message());
    for (int i = 0; i < 3; ++i) {
      live->place("map", "base_link", Eigen::Isometry3d::Identity(), kSecond);
      live->send(*points, bad.message());
    }
    EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), words); })) << words;
  };
  std::string nowhere = "no\nwhere";  // one line all the same
  complaint("no transform connects 'base_link' and 'no\\x0awhere'",
            [&](auto& m) { m.header.frame_id = nowhere.data(); });
  complaint("no field 'x'", [](auto& m) { ++m.fields._buffer, --m.fields._length; });
  complaint("bytes are no", [](auto& m) { m.width *= 2; });
  complaint("no field 'label'", [](auto& m) { --m.fields._length; });
  complaint("no pose", [&](auto&) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = NAN;
    live->place("map", "base_link", T, kSecond);
  });
  const std::size_t inserted = count(live->said(), "points inserted");
  live->place("map", "base_link", Eigen::Isometry3d::Identity(), 100 * kSecond);
  live->place("map", "base_link", Eigen::Isometry3d::Identity(), kSecond);
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "went back"); }));
  live->send(*points, good.message());
  EXPECT_TRUE(live->waitForScans(inserted + 1));
  EXPECT_EQ(live->end(), kStopped);
  for (const char* words : {"where'", "no field 'x'", "no field 'label'", "Twist_"})
    EXPECT_LE(count(live->said(), words), 2u)
        << words << live->said();  // once, and how often at the end
  EXPECT_FALSE(live->map().empty());
}

TEST_F(RoadInGrass, saysOnceThatARobotInUtmIsOutsideOfTheMap) {
  start({});
  for (int i = 1; i <= 4; ++i) {
    const Eigen::Translation3d easting(500000 + i, 4e6, 0);
    live->place("map", "base_link", Eigen::Isometry3d(easting), i * kSecond);
    live->send(*points, PointMessage(scan(), "lidar", i * kSecond).message());
    EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "subtract the same offset"); }));
  }
  live->place("map", "base_link", Eigen::Isometry3d::Identity(), 5 * kSecond);
  live->send(*points, PointMessage(scan(), "lidar", 5 * kSecond).message());
  live->waitForScans(1);  // those before it have come, too
  live->end();
  EXPECT_EQ(count(live->said(), "outside the map"), 2u) << live->said();  // and how often
}

TEST_F(RoadInGrass, isNotSavedWhereNothingCame) {
  start({});
  EXPECT_EQ(live->end(), 1);
  EXPECT_TRUE(contains(live->said(), "no scan came"));
  EXPECT_FALSE(std::filesystem::exists(live->folder / "map.semantic"));
}

TEST(RosArgumentsOfProgram, areRefusedWithTheirNames) {
  EXPECT_NE(LiveMap({"-r", "a=b"}).said().find("expected FROM:=TO"), std::string::npos);
  EXPECT_NE(LiveMap({"-p", "insertion.max_rnge:=3"}).said().find("max_range"), std::string::npos);
  EXPECT_NE(LiveMap({"-r", "points:=a b"}).said().find("'/a b' is no name of a topic"),
            std::string::npos);
}
