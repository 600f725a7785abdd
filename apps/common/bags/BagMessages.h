#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "point_fields/PointFields.h"

namespace bags {

constexpr const char* kPointCloud2 = "sensor_msgs/msg/PointCloud2";
constexpr const char* kTransforms = "tf2_msgs/msg/TFMessage";
constexpr const char* kOdometry = "nav_msgs/msg/Odometry";

/** Nanoseconds since 1970. */
using Stamp = std::int64_t;

/** A cloud, which refers to the message's bytes. */
struct BagCloud {
  Stamp stamp = 0;
  std::string frame;
  point_fields::RawCloud points;
};

/** Where a frame is in its parent. Nothing of it is known to be a pose. */
struct FramePose {
  Stamp stamp = 0;
  std::string parent, child;
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
};

// Messages as ROS 2 writes them (CDR, of either byte order). \throw std::runtime_error they end too
// early, or are of another encoding.

BagCloud cloudOfMessage(std::string_view message);
/** The transforms in a tf2_msgs/TFMessage. */
std::vector<FramePose> transformsOfMessage(std::string_view message);
FramePose odometryOfMessage(std::string_view message);

}  // namespace bags
