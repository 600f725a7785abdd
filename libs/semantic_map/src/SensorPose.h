#pragma once
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>

namespace semantic_map {

/** T_map_sensor as Eigen knows it. \throw std::invalid_argument a pose is not finite. */
Eigen::Isometry3d sensorPose(const mrpt::poses::CPose3D& T_map_robot,
                             const mrpt::poses::CPose3D& T_robot_sensor);

}  // namespace semantic_map
