#pragma once
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace semantic_map_edit {

/** \param v x, y, z (m), yaw, pitch, roll (degrees), as MRPT's CPose3D. */
inline Eigen::Isometry3d poseOfNumbers(const std::array<double, 6>& v) {
  constexpr double kDegree = M_PI / 180;
  const mrpt::poses::CPose3D pose(v[0], v[1], v[2], v[3] * kDegree, v[4] * kDegree, v[5] * kDegree);
  return Eigen::Isometry3d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
}

}  // namespace semantic_map_edit
