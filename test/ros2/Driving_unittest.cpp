#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "RoadInGrass.h"

namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

ros2::PoseStamped goalAt(double x, double y, const std::string& frame) {
  ros2::PoseStamped goal{};
  goal.header = ros2::headerOf(0, frame);
  goal.pose.position = {x, y, 0};
  goal.pose.orientation.w = 1;
  return goal;
}

ros2::Stamp now() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

/** What a LiDAR sees that stands in a room of 14 x 10 m, with a cupboard in a corner. */
semantic_types::LabeledCloud room() {
  semantic_types::LabeledCloud cloud;
  for (int ring = -15; ring < 10; ++ring)
    for (int column = 0; column < 360; ++column) {
      const Eigen::Vector3d ray(std::cos(column * M_PI / 180), std::sin(column * M_PI / 180),
                                std::tan(ring * M_PI / 90));
      const auto until = [&](int axis, double low, double high) {
        return ray[axis] == 0 ? 1e9 : (ray[axis] > 0 ? high : low) / ray[axis];
      };
      double range = std::min({until(0, -8, 6), until(1, -4, 6), until(2, -1, 2)});
      if (ray.x() > 0 && ray.y() > 0) range = std::min(range, std::max(4 / ray.x(), 3 / ray.y()));
      cloud.points.push_back((range * ray).cast<float>());
      cloud.classes.push_back(3);
    }
  return cloud;
}

TEST_F(RoadInGrass, hasAPathToAGoal) {
  start({"-p", "order:=" + order()});
  Heard<ros2::Path> paths(*live, "/plan");
  ros2::Publication<ros2::PoseStamped> goals(live->node(), "goal_pose", {});
  see(1);
  const std::string map = "map", other = "moon";
  live->send(goals, goalAt(5, 0, other));
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "a goal cannot be understood"); }));
  live->send(goals, goalAt(5, 0, map));
  ASSERT_TRUE(live->waitFor([&] { return paths.last() != nullptr; })) << live->said();
  const auto path = paths.last();
  ASSERT_GT(path->poses._length, 5u) << live->said();
  const auto& end = path->poses._buffer[path->poses._length - 1];
  EXPECT_EQ(ros2::textOf(end.header.frame_id), "map");
  EXPECT_NEAR(end.pose.position.x, 5, 0.01);
  live->send(goals, goalAt(50, 0, map));
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "Goal: no path"); }));
  EXPECT_EQ(live->end(), kStopped);
}

/** A robot that does at once what it is told. */
class DrivenRobot : public RoadInGrass {
 protected:
  void SetUp() override {
    const std::string sources = MSO_SOURCE_DIR;
    start({"-p", "order:=" + order(), "-p", "drive:=true", "-p",
           "drive.reactive:=" + sources + "/config/reactive/robot.ini", "-p",
           "movers.classes:=", "-p", "planner.vehicle:=" + sources + "/config/vehicles/robot.yaml",
           "-p", "abstraction.relevant:=road: 1", "-p", "explore.budget:=2"});
    commands = std::make_unique<Heard<ros2::Twist>>(*live, "/cmd_vel");
    goals = std::make_unique<ros2::Publication<ros2::PoseStamped>>(live->node(), "goal_pose",
                                                                   ros2::Qos());
    odometry =
        std::make_unique<ros2::Publication<ros2::Odometry>>(live->node(), "odom", ros2::Qos());
  }
  /** It and what it sees of the world, for 50 ms. */
  void step() {
    constexpr double kSeconds = 0.05;
    const std::string map = "map", base = "base_link";
    const auto command = commands->last();
    const double speed = command ? command->linear.x : 0, turn = command ? command->angular.z : 0;
    heading += kSeconds * turn, driven += kSeconds * std::abs(speed);
    x += kSeconds * speed * std::cos(heading), y += kSeconds * speed * std::sin(heading);
    ros2::Odometry message{};
    const ros2::Stamp stamp = now();
    message.header = ros2::headerOf(stamp, map);
    message.child_frame_id = ros2::textOf(base);
    message.pose.pose = {{x, y, 0}, {0, 0, std::sin(heading / 2), std::cos(heading / 2)}};
    message.twist.twist.linear.x = speed, message.twist.twist.angular.z = turn;
    odometry->write(message);
    if (steps++ % 10 == 0) points->write(PointMessage(seen(), "lidar", stamp).message());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  /** scan() from where the robot is. */
  semantic_types::LabeledCloud seen() const {
    const auto all = scan();
    semantic_types::LabeledCloud cloud;
    const Isometry3d T =
        Isometry3d(Translation3d(x, y, 0) * AngleAxisd(heading, Vector3d::UnitZ()));
    const Vector3d sensor(0.05, 0.05, 30);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Vector3d p = T.inverse() * (all.points[i].cast<double>() + sensor);
      if (p.norm() > sight) continue;
      cloud.points.push_back((p - sensor).cast<float>());
      cloud.classes.push_back(all.classes[i]);
    }
    return cloud;
  }
  bool drivesUntil(const std::string& said) {
    return live->waitFor([&] { return step(), contains(live->said(), said); });
  }
  bool stands() {
    return live->waitFor([&] { return step(), commands->last()->linear.x == 0; });
  }

  double x = 0, y = 0, heading = 0, driven = 0;
  double sight = 100;  ///< m
  std::size_t steps = 0;
  std::unique_ptr<Heard<ros2::Twist>> commands;
  std::unique_ptr<ros2::Publication<ros2::PoseStamped>> goals;
  std::unique_ptr<ros2::Publication<ros2::Odometry>> odometry;
};

}  // namespace

TEST_F(DrivenRobot, exploresByAMessageUntilItIsOverOrEndedAndComesToAGoal) {
  Heard<ros2::Path> paths(*live, "/plan");
  ros2::Publication<ros2::Bool> explores(live->node(), "/semantic_map/explore", {});
  live->send(explores, {true});
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "nothing was seen yet"); }));
  sight = 4;
  drivesUntil("points inserted");
  live->send(explores, {true});
  EXPECT_TRUE(drivesUntil("the robot explored; the budget is driven")) << live->said();
  EXPECT_NEAR(driven, 2, 1);
  const auto drivesOn = [&] {
    const double from = driven;
    return live->waitFor([&] { return step(), driven > from + 0.3; });
  };
  live->send(explores, {true});
  EXPECT_TRUE(drivesOn());
  live->send(explores, {false});
  EXPECT_TRUE(drivesUntil("the robot explored; it was ended"));
  EXPECT_TRUE(stands());
  live->send(explores, {true});
  EXPECT_TRUE(drivesOn());
  live->send(*goals, goalAt(0, 0, "map"));
  EXPECT_TRUE(drivesUntil("the robot is there")) << live->said();
  EXPECT_LT(std::hypot(x, y), 0.5);
  EXPECT_GT(paths.all().size(), 0u);
  EXPECT_TRUE(stands());
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

/** The last transform from map to odom. */
const ros2::TransformStamped* correctionIn(const Heard<ros2::TFMessage>& transforms) {
  const ros2::TransformStamped* last = nullptr;
  for (const auto& message : transforms.all())
    for (std::uint32_t i = 0; i < message->transforms._length; ++i)
      if (ros2::textOf(message->transforms._buffer[i].child_frame_id) == "odom")
        last = &message->transforms._buffer[i];
  return last;
}

/** The robot is carried, and a person says roughly where it is. */
TEST_F(RoadInGrass, isWhereAnInitialPoseHasIt) {
  start({"-p", "slam:=true", "-p", "slam.level:=true"});
  Heard<ros2::TFMessage> transforms(*live, "/tf");
  ros2::Publication<ros2::PoseWithCovarianceStamped> poses(live->node(), "initialpose", {});
  const auto poseAt = [](double x, double y, double heading) {
    return Isometry3d(Translation3d(x, y, 0) * AngleAxisd(heading, Vector3d::UnitZ()));
  };
  // Walls are then in the middle of voxels, which are what the map says of them.
  const Isometry3d T_map_room = poseAt(0.1, 0.1, 0), T_odometry_robot = T_map_room,
                   T_room_carried = poseAt(2, 1, M_PI / 4);
  const auto seeFrom = [&](const Isometry3d& T_room_robot, int number) {
    auto cloud = room();
    for (auto& p : cloud.points) p = (T_room_robot.inverse() * p.cast<double>()).cast<float>();
    live->place("odom", "base_link", T_odometry_robot, number * kSecond);
    live->send(*points, PointMessage(cloud, "base_link", number * kSecond).message());
    ASSERT_TRUE(live->waitForScans(std::size_t(number)));
  };
  for (int i = 1; i <= 3; ++i) seeFrom(Isometry3d::Identity(), i);
  const std::string map = "map";
  ros2::PoseWithCovarianceStamped near{};
  near.header = ros2::headerOf(0, map);
  const double heading = M_PI / 4 + 0.08;
  near.pose.pose = {{2.3, 0.95, 0}, {0, 0, std::sin(heading / 2), std::cos(heading / 2)}};
  auto nowhere = near;
  nowhere.pose.pose.position.x = NAN;
  live->send(poses, nowhere);
  ASSERT_TRUE(live->waitFor(
      [&] { return contains(live->said(), "an initial pose cannot be understood"); }));
  live->send(poses, near);
  ASSERT_TRUE(
      live->waitFor([&] { return contains(live->said(), "where an initial pose has it"); }));
  const Isometry3d said = poseAt(2.3, 0.95, heading) * T_odometry_robot.inverse();
  ASSERT_TRUE(live->waitFor([&] {  // at once, before the next scan
    const auto* last = correctionIn(transforms);
    return last && std::abs(last->transform.translation.x - said(0, 3)) < 1e-6 &&
           std::abs(last->transform.translation.y - said(1, 3)) < 1e-6;
  }));
  for (int i = 4; i <= 6; ++i) seeFrom(T_room_carried, i);
  ASSERT_TRUE(live->waitFor([&] {
    const auto* last = correctionIn(transforms);
    return last && ros2::stampOf(last->header.stamp) >= 6 * kSecond;
  }));
  EXPECT_EQ(ros2::textOf(correctionIn(transforms)->header.frame_id), "map");
  const auto& T = correctionIn(transforms)->transform;
  const Isometry3d expected = T_map_room * T_room_carried * T_odometry_robot.inverse();
  EXPECT_NEAR(T.translation.x, expected(0, 3), 0.06);
  EXPECT_NEAR(T.translation.y, expected(1, 3), 0.06);
  EXPECT_NEAR(2 * std::atan2(T.rotation.z, T.rotation.w), M_PI / 4, 0.02);
  EXPECT_EQ(live->end(), kStopped) << live->said();
}

TEST_F(RoadInGrass, saysWhatItNeedsForAnInitialPoseAndToExplore) {
  start({});
  ros2::Publication<ros2::PoseWithCovarianceStamped> poses(live->node(), "initialpose", {});
  ros2::Publication<ros2::Bool> explores(live->node(), "/semantic_map/explore", {});
  live->send(poses, {});
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "an initial pose came, but"); }));
  live->send(explores, {true});
  EXPECT_TRUE(live->waitFor([&] { return contains(live->said(), "explore: there is no order"); }));
}
