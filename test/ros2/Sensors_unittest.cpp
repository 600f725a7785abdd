#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "LiveMap.h"
#include "WaitingLabels.h"

namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using ros2::Stamp;
using semantic_octree::CellState;

constexpr Stamp kSecond = 1'000'000'000;
const std::string kTwoClasses =
    "classes:\n  - {id: 1, name: road, color: [90, 90, 100], raw: [7]}\n"
    "  - {id: 2, name: wall, color: [200, 100, 60], raw: [9]}\n";

Isometry3d at(double x, double y, double z) { return Isometry3d(Translation3d(x, y, z)); }

ros2::Odometry odometryAt(Stamp stamp, double x) {
  static const std::string odom = "odom", base = "base_link";
  ros2::Odometry pose{};
  pose.header = ros2::headerOf(stamp, odom);
  pose.child_frame_id = ros2::textOf(base);
  pose.pose.pose.position.x = x;
  pose.pose.pose.orientation.w = 1;
  return pose;
}

/** Beams from ahead to the left, 22.5 degrees apart. */
ros2::LaserScan laserScan(const std::vector<float>& ranges) {
  ros2::LaserScan scan{};
  scan.angle_increment = float(M_PI / 8);
  scan.range_min = 0.1f, scan.range_max = 20;
  ros2::refer(scan.ranges, ranges);
  return scan;
}

/** Voxels of 0.2 m, poses in "map". */
class LiveSensors : public testing::Test {
 protected:
  void start(std::vector<std::string> parameters = {}) {
    parameters.insert(parameters.begin(),
                      {"-p", "map.resolution:=0.2", "-p",
                       "map.classes:=" + folder.write("c.yaml", kTwoClasses).string(), "-p",
                       "transform_timeout:=100"});
    live = std::make_unique<LiveMap>(parameters);
  }
  CellState end(double x, double y, double z) {
    EXPECT_EQ(live->end(), kStopped) << live->said();
    return live->map().query(x, y, z);
  }

  TemporaryFolder folder;
  std::unique_ptr<LiveMap> live;
};

}  // namespace

TEST(WaitingLabels, haveRoomForAsMuchAsIsPromisedAndKeepTheNewest) {
  semantic_map_ros2::WaitingLabels labels;
  const auto add = [&](int second, std::uint32_t bytes) {
    ros2::Image image{};
    image.header.stamp.sec = second;
    image.data._length = bytes;  // which nobody reads
    labels.add(std::make_shared<ros2::Image>(image));
  };
  for (int second = 1; second <= 9; ++second) add(second, 100'000'000);
  EXPECT_FALSE(labels.has(4 * kSecond));
  EXPECT_TRUE(labels.has(5 * kSecond));
  EXPECT_EQ(labels.take(8 * kSecond)->header.stamp.sec, 8);
  EXPECT_FALSE(labels.has(7 * kSecond)) << "depth images of before do not come any more";
  EXPECT_FALSE(labels.take(8 * kSecond));
  for (int second = 10; second <= 70; ++second) add(second, 1);
  EXPECT_FALSE(labels.has(20 * kSecond));
  EXPECT_TRUE(labels.has(21 * kSecond));
  add(71, 600'000'000);
  EXPECT_TRUE(labels.has(71 * kSecond)) << "one has room whatever it takes";
  EXPECT_FALSE(labels.has(70 * kSecond));
  add(40, 1);
  EXPECT_FALSE(labels.has(71 * kSecond)) << "the clock went back";
}

TEST_F(LiveSensors, laserScansAndOdometry) {
  start({"-p", "map_frame:=odom", "-r", "scan:=/front/laser", "-r", "odom:=/wheels"});
  const std::string frame = "laser";
  live->place("base_link", frame, at(0.1, 0, 0.5), 0, true);
  ros2::Publication<ros2::Odometry> odometry(live->node(), "/wheels", {});
  ros2::Publication<ros2::LaserScan> scans(live->node(), "/front/laser",
                                           {false, false, 5});  // best effort
  const std::vector<float> ranges = {2, INFINITY, NAN, 0.01f, 3};
  ros2::LaserScan scan = laserScan(ranges);
  scan.header = ros2::headerOf(5 * kSecond, frame);
  live->send(odometry, odometryAt(5 * kSecond, 10));
  // A reliable reader does not match: it changes when it has seen that.
  EXPECT_TRUE(live->waitFor([&] {
    if (scans.isRead()) scans.write(scan);
    return contains(live->said(), "points inserted");
  }));
  EXPECT_EQ(end(12.1, 0.05, 0.5).status, CellState::Status::Occupied);
  const auto map = live->map();
  EXPECT_EQ(map.query(10.1, 3, 0.5).status, CellState::Status::Occupied);
  EXPECT_EQ(map.query(11, 0.05, 0.5).status, CellState::Status::Free);
}

TEST_F(LiveSensors, beamsOfALaserThatTakeTimeAreSeenFromWhereTheRobotIsByThen) {
  start({"-p", "map_frame:=odom"});
  const std::string base = "base_link";
  ros2::Publication<ros2::Odometry> odometry(live->node(), "odom", {});
  ros2::Publication<ros2::LaserScan> scans(live->node(), "scan", {true, false, 5});
  const std::vector<float> ranges = {2, 2, 2, 2, 3.1f};
  ros2::LaserScan scan = laserScan(ranges);
  scan.time_increment = 0.125f;
  for (int second : {5, 6}) {  // at 1 m/s along x
    live->send(odometry, odometryAt(second * kSecond, second));
    scan.header = ros2::headerOf(second * kSecond, base);
    live->send(scans, scan);
  }
  ASSERT_TRUE(live->waitForScans(2)) << live->said();
  EXPECT_EQ(end(6.5, 3.1, 0.1).status, CellState::Status::Occupied);
  EXPECT_NE(live->map().query(6.1, 3.1, 0.1).status, CellState::Status::Occupied);
}

TEST_F(LiveSensors, depthAndLabelImages) {
  start();
  const std::string frame = "optical", depthEncoding = "32FC1", labelEncoding = "mono16";
  Isometry3d T = at(0, 0, 1);  // looks along x
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  live->place("base_link", frame, T, 0, true);
  ros2::Publication<ros2::Image> depth(live->node(), "depth/image", {}),
      labels(live->node(), "labels/image", {});
  ros2::Publication<ros2::CameraInfo> cameras(live->node(), "depth/camera_info", {});
  std::vector<float> meters(16, 3.0f);
  meters[5] = NAN, meters[6] = -1;
  std::vector<std::uint16_t> ids(16, 9);
  std::vector<std::uint8_t> depthBytes(64), labelBytes(32);
  std::memcpy(depthBytes.data(), meters.data(), 64);
  std::memcpy(labelBytes.data(), ids.data(), 32);
  ros2::CameraInfo info{};
  info.width = info.height = 4;
  info.k[0] = info.k[4] = 4, info.k[2] = info.k[5] = 1.5, info.k[8] = 1;
  live->send(cameras, info);
  ros2::Image image{};
  image.header = ros2::headerOf(kSecond, frame);
  image.width = image.height = 4;
  image.encoding = ros2::textOf(depthEncoding), image.step = 16;
  ros2::refer(image.data, depthBytes);
  live->send(depth, image);
  image.encoding = ros2::textOf(labelEncoding), image.step = 8;
  ros2::refer(image.data, labelBytes);
  for (int i = 0; i < 60; ++i) {  // of before the clock went back
    image.header.stamp.sec = 100 + i;
    live->send(labels, image);
  }
  image.header.stamp.sec = 1;
  live->send(labels, image);
  live->place("map", "base_link", at(1, 0, 0), kSecond);
  ASSERT_TRUE(live->waitForScans(1));
  EXPECT_TRUE(contains(live->said(), "14 points inserted")) << live->said();
  const CellState state = end(4, 3 * -0.375, 1 - 3 * 0.375);
  EXPECT_EQ(state.status, CellState::Status::Occupied);
  EXPECT_EQ(state.likeliestClass, 2);
}

TEST_F(LiveSensors, colorsAreClassesAndTimeIsTheClocks) {
  start({"-p", "class_field:=rgb", "-p", "use_sim_time:=true", "-p", "transform_timeout:=2"});
  live->place("base_link", "lidar", at(0, 0, 1), 0, true);
  ros2::Publication<ros2::PointCloud2> points(live->node(), "points", {});
  ros2::Publication<ros2::Clock> clock(live->node(), "/clock", {false, false, 1});
  semantic_types::LabeledCloud cloud;
  cloud.points = {{3, 0, -1}};
  PointMessage message(cloud, "lidar", 10 * kSecond, "rgb");
  std::vector<std::uint8_t> data(16);
  std::memcpy(data.data(), cloud.points[0].data(), 12);
  const std::uint32_t rgb = 200 << 16 | 100 << 8 | 60;
  std::memcpy(&data[12], &rgb, 4);
  message.message().fields._buffer[3].datatype = 7;
  message.message().point_step = message.message().row_step = 16;
  ros2::refer(message.message().data, data);
  const auto say = [&](Stamp now) { live->send(clock, {ros2::timeOf(now)}); };
  say(10 * kSecond);
  live->send(points, message.message());
  // Its transform does not come for as long as the clock stands; then for longer than it may wait.
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_FALSE(contains(live->said(), "left out")) << live->said();
  EXPECT_TRUE(live->waitFor([&] { return say(13 * kSecond), contains(live->said(), "left out"); }));
  message.message().header.stamp = ros2::timeOf(13 * kSecond);
  live->place("map", "base_link", at(0, 0, 0), 13 * kSecond);
  live->send(points, message.message());
  ASSERT_TRUE(live->waitForScans(1));
  EXPECT_EQ(end(3, 0.05, 0.05).likeliestClass, 2);
}
