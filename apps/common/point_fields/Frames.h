#pragma once
#include <Eigen/Geometry>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace point_fields {

/** Nanoseconds since 1970, or of a simulation. */
using Stamp = std::int64_t;

/** Where a frame is in its parent, as a message has it: nothing of it is known to be a pose. */
struct FramePose {
  Stamp stamp = 0;
  std::string parent, child;
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
};

/** Where frames are: what /tf, /tf_static and odometry say. Any thread may ask. Names of frames may
 * begin with a slash, as those of ROS 1 do. */
class Frames {
 public:
  enum class Kind { Moving, Static, Odometers };  ///< an odometer's counts where /tf does not tell

  /** \param isLive only the last half minute counts, a frame may get another parent, and peers
   * cannot fill memory; otherwise all is kept, and the first parent stays */
  explicit Frames(bool isLive) : m_isLive(isLive) {}

  /** \return what is wrong with it, if anything; then it is not taken, but where stamps went back
   */
  std::string add(const FramePose& pose, Kind kind);

  struct Answer {
    std::optional<Eigen::Isometry3d> T_target_source;
    std::string problem;  ///< why there is none
    bool isLost = false;  ///< and there will not be one
  };
  /** Between the two stamps around it transforms are interpolated. */
  Answer find(const std::string& target, const std::string& source, Stamp stamp) const;
  /** The last stamp at which the way between two frames is known; none if it is not, or static. */
  std::optional<Stamp> latest(const std::string& target, const std::string& source) const;
  /** The first frame that moves, from a sensor's upwards: the robot. Empty: nothing moves. */
  std::string robotOf(const std::string& sensor) const;
  /** The highest frame above one: the map's. */
  std::string rootOf(const std::string& frame) const;

 private:
  struct Pose {
    Eigen::Vector3d translation;
    Eigen::Quaterniond rotation;
    Eigen::Isometry3d isometry() const { return Eigen::Translation3d(translation) * rotation; }
  };
  struct Frame {
    std::string parent;
    Kind kind = Kind::Moving;
    std::map<Stamp, Pose> poses;
    std::optional<Eigen::Isometry3d> at(Stamp stamp) const;
  };
  using Chain = std::vector<std::string>;
  /** The frame and those above it. */
  Chain chainOf(std::string frame) const;
  bool parts(const std::string& target, const std::string& source, Chain& up, Chain& down) const;
  void forgetOld(Frame& frame) const;

  bool m_isLive;
  mutable std::mutex m_mutex;
  std::map<std::string, Frame> m_frames;
};

}  // namespace point_fields
