#pragma once
#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "point_fields/PointFields.h"

namespace bags {

constexpr const char* kPointCloud2 = "sensor_msgs/msg/PointCloud2";
constexpr const char* kImage = "sensor_msgs/msg/Image";
constexpr const char* kCameraInfo = "sensor_msgs/msg/CameraInfo";
constexpr const char* kLaserScan = "sensor_msgs/msg/LaserScan";
constexpr const char* kTransforms = "tf2_msgs/msg/TFMessage";
constexpr const char* kOdometry = "nav_msgs/msg/Odometry";

/** Nanoseconds since 1970. */
using Stamp = std::int64_t;

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
  float firstAngle = 0, angleStep = 0, leastRange = 0, mostRange = 0;  ///< rad, m
  std::vector<float> ranges;
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

/** The message begins with a header. */
BagHeader headerOfMessage(std::string_view message);
BagCloud cloudOfMessage(std::string_view message);
BagImage imageOfMessage(std::string_view message);
point_fields::RawCamera cameraOfMessage(std::string_view message);
BagLaserScan laserScanOfMessage(std::string_view message);
/** The transforms in a tf2_msgs/TFMessage. */
std::vector<FramePose> transformsOfMessage(std::string_view message);
FramePose odometryOfMessage(std::string_view message);

/** Where the frames of a bag are, at all times: what /tf, /tf_static and odometry say. */
class BagFrames {
 public:
  /** What is no pose, or makes a ring of frames, is left out. */
  void add(const FramePose& pose, bool isStatic);
  /** It counts for frames that no transform tells of. Call it after all add(). */
  void addOdometry(const FramePose& pose);

  /** The frame that moves, from a sensor's upwards: the robot. Empty: nothing moves. */
  std::string robotOf(const std::string& sensor) const;
  /** Between the stamps around it the movement is interpolated.
   * \param above empty: the highest frame of all, which is the map's
   * \return none: the transforms do not tell */
  std::optional<Eigen::Isometry3d> find(const std::string& frame, Stamp stamp,
                                        const std::string& above = {}) const;

 private:
  struct Frame {
    std::string parent;
    bool isStatic = false, isOdometers = false;
    std::map<Stamp, Eigen::Isometry3d> poses;
  };
  void add(const FramePose& pose, bool isStatic, bool isOdometers);
  std::optional<Eigen::Isometry3d> at(const Frame& frame, Stamp stamp) const;

  std::map<std::string, Frame> m_frames;
};

}  // namespace bags
