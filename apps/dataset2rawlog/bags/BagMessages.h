#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "point_fields/Frames.h"
#include "point_fields/PointFields.h"

namespace bags {

constexpr const char* kPointCloud2 = "sensor_msgs/msg/PointCloud2";
constexpr const char* kImage = "sensor_msgs/msg/Image";
constexpr const char* kCameraInfo = "sensor_msgs/msg/CameraInfo";
constexpr const char* kLaserScan = "sensor_msgs/msg/LaserScan";
constexpr const char* kTransforms = "tf2_msgs/msg/TFMessage";
constexpr const char* kOdometry = "nav_msgs/msg/Odometry";

using point_fields::FramePose;
using point_fields::Stamp;

/** When and in which frame something was seen. */
struct BagHeader {
  Stamp stamp = 0;
  std::string frame;
};

/** A cloud, which refers to the message's bytes. */
struct BagCloud : BagHeader {
  point_fields::RawCloud points;
};

/** An image, which refers to the message's bytes. */
struct BagImage : BagHeader {
  point_fields::RawImage pixels;
};

struct BagLaserScan : BagHeader {
  point_fields::RawLaserScan beams;
};

// Messages as ROS 2 writes them (CDR, of either byte order). \throw std::runtime_error they end too
// early, or are of another encoding.

/** The message begins with a header. */
BagHeader headerOfMessage(std::string_view message);
BagCloud cloudOfMessage(std::string_view message);
BagImage imageOfMessage(std::string_view message);
point_fields::RawCamera cameraOfMessage(std::string_view message);
BagLaserScan laserScanOfMessage(std::string_view message);
/** The transforms in a tf2_msgs/TFMessage. */
std::vector<FramePose> transformsOfMessage(std::string_view message);
FramePose odometryOfMessage(std::string_view message);

}  // namespace bags
