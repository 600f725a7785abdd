#pragma once
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>

namespace labeled_cloud {

inline Eigen::Isometry3d toEigen(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.matrix() = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  return T;
}

}  // namespace labeled_cloud
