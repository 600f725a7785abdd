#pragma once
#include <Eigen/Geometry>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ros2/Messages.h"

namespace semantic_map_ros2 {

using ros2::Stamp;

/** Where frames are, for the last half minute: what /tf and /tf_static say. Any thread may ask. */
class Transforms {
 public:
  /** \return what is wrong with it, if anything; then it is not taken */
  std::string add(const ros2::TransformStamped& transform, bool isStatic);
  /** Takes an odometer's message: it counts for a frame that /tf does not tell of. */
  std::string add(const ros2::Odometry& odometry);

  struct Answer {
    std::optional<Eigen::Isometry3d> T_target_source;
    std::string problem;  ///< why there is none
    bool isLost = false;  ///< and there will not be one
  };
  /** Between the two stamps around it transforms are interpolated. */
  Answer find(const std::string& target, const std::string& source, Stamp stamp) const;
  /** The last stamp at which the way between two frames is known; none if it is not, or static. */
  std::optional<Stamp> latest(const std::string& target, const std::string& source) const;

 private:
  struct Pose {
    Eigen::Vector3d translation;
    Eigen::Quaterniond rotation;
  };
  struct Frame {
    std::string parent;
    bool isStatic = false, isOdometers = false;
    std::map<Stamp, Pose> poses;
  };
  using Chain = std::vector<std::string>;
  std::string take(const ros2::Header& header, const char* child, const Pose& pose, bool isStatic,
                   bool isOdometers);
  /** The frame and those above it. */
  Chain chainOf(std::string frame) const;
  bool parts(const std::string& target, const std::string& source, Chain& up, Chain& down) const;
  static std::optional<Eigen::Isometry3d> at(const Frame& frame, Stamp stamp);

  mutable std::mutex m_mutex;
  std::map<std::string, Frame> m_frames;
};

/** A message's pose or transform. */
Eigen::Isometry3d isometryOf(const geometry_msgs_msg_dds__Pose_& pose);
geometry_msgs_msg_dds__Pose_ poseOf(const Eigen::Isometry3d& T);
geometry_msgs_msg_dds__Transform_ transformOf(const Eigen::Isometry3d& T);

}  // namespace semantic_map_ros2
