#pragma once
#include <gtest/gtest.h>

#include "../semantic_planning/PaintedWorld.h"
#include "LiveMap.h"

/** A road along x in grass with a wall beside it and mud at its end, seen from above. */
class RoadInGrass : public testing::Test {
 protected:
  static constexpr ros2::Stamp kSecond = 1'000'000'000;

  void start(std::vector<std::string> parameters) {
    parameters.insert(parameters.begin(),
                      {"-p", "map.resolution:=0.2", "-p", "map.classes:=" + classes(), "-p",
                       "transform_timeout:=100", "-p", "publish_period:=0"});
    live = std::make_unique<LiveMap>(parameters);
    live->place("base_link", "lidar", Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.05, 30)), 0,
                true);
    points =
        std::make_unique<ros2::Publication<ros2::PointCloud2>>(live->node(), "points", ros2::Qos());
  }
  std::string classes() const {
    return folder
        .write("classes.yaml",
               "classes:\n  - {id: 1, name: road, color: [90, 90, 100]}\n"
               "  - {id: 2, name: grass, color: [100, 200, 80]}\n  - {id: 3, name: wall, color: "
               "[200, 100, 60]}\n"
               "  - {id: 4, name: mud, color: [120, 80, 40]}\n")
        .string();
  }
  std::string order() const {
    return folder.write("order.yaml", "best_to_worst: [road, grass]\n").string();
  }

  /** The scan with the robot at the origin. */
  static semantic_types::LabeledCloud scan() {
    semantic_types::LabeledCloud cloud;
    const auto add = [&](int x, int y, int z, int id) {
      const auto center = [](int i) { return (float(i) + 0.5f) * 0.2f; };
      cloud.points.push_back(Eigen::Vector3f(center(x), center(y), center(z)) -
                             Eigen::Vector3f(0.05f, 0.05f, 30));
      cloud.classes.push_back(semantic_types::ClassId(id));
    };
    for (int x = -50; x < 50; ++x)
      for (int y = -30; y < 30; ++y) {
        const bool isWall = std::abs(x) < 10 && y >= 20 && y < 22;
        const int ground = std::abs(y) < 10 ? 1 : 2;
        if (!isWall) add(x, y, -1, x >= 35 ? 4 : ground);
        for (int z = 0; isWall && z < 10; ++z) add(x, y, z, 3);
      }
    return cloud;
  }
  /** Sends a scan, and waits until the map has it. \param number counts from 1 */
  void see(std::size_t number, const semantic_types::LabeledCloud& cloud = scan()) {
    const ros2::Stamp stamp = ros2::Stamp(number) * kSecond;
    live->place("map", "base_link", Eigen::Isometry3d::Identity(), stamp);
    live->send(*points, PointMessage(cloud, "lidar", stamp).message());
    live->waitForScans(number);
  }

  TemporaryFolder folder;
  std::unique_ptr<LiveMap> live;
  std::unique_ptr<ros2::Publication<ros2::PointCloud2>> points;
};
