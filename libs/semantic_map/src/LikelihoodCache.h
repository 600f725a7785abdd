#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

namespace semantic_map {

/** T_map_sensor as Eigen knows it. \throw std::invalid_argument a pose is not finite. */
inline Eigen::Isometry3d sensorPose(const mrpt::poses::CPose3D& T_map_robot,
                                    const mrpt::poses::CPose3D& T_robot_sensor) {
  const auto finite = [](const mrpt::poses::CPose3D& pose, const char* whose) {
    const Eigen::Isometry3d T = labeled_cloud::toEigen(pose);
    if (!T.matrix().allFinite())
      throw std::invalid_argument(std::string("the pose of the ") + whose + " is not finite");
    return T;
  };
  return finite(T_map_robot, "robot") * finite(T_robot_sensor, "sensor");
}

/** The scan of the observation whose likelihood was asked for last. Particle filters ask at many
 * poses, some from several threads. */
struct LikelihoodCache {
  std::mutex mutex;
  std::string source;  ///< observation and options, as archives have them; empty: no scan
  std::shared_ptr<const labeled_cloud::LabeledScan> scan;
  std::string refusal;  ///< that was said last
};

}  // namespace semantic_map
