#include "SensorPose.h"

#include <stdexcept>

namespace semantic_map {

using mrpt::poses::CPose3D;

namespace {

Eigen::Isometry3d isometry(const CPose3D& pose, const char* whose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto& R = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 3; ++col) T.linear()(row, col) = R(row, col);
  T.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  if (!T.matrix().allFinite())
    throw std::invalid_argument(std::string("the pose of the ") + whose + " is not finite");
  return T;
}

}  // namespace

Eigen::Isometry3d sensorPose(const CPose3D& T_map_robot, const CPose3D& T_robot_sensor) {
  return isometry(T_map_robot, "robot") * isometry(T_robot_sensor, "sensor");
}

}  // namespace semantic_map
