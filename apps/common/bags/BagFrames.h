#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "BagMessages.h"

namespace bags {

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
