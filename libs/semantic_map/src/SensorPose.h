#pragma once
#include <labeled_cloud/Trajectory.h>

#include <stdexcept>

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

}  // namespace semantic_map
