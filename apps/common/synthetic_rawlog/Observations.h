#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>

#include <opencv2/core/mat.hpp>

// What the sensors of the synthetic world see, as MRPT's observations.
namespace synthetic_rawlog {

mrpt::poses::CPose3D toMrpt(const Eigen::Isometry3d& pose);

/** Blue, green, red. */
cv::Mat3b pictureOf(const synthetic_world::Image<synthetic_world::Color>& image);

mrpt::obs::CObservationRobotPose::Ptr robotPose(const Eigen::Isometry3d& T_map_robot);

/** Most classes of a camera's pixels. */
constexpr int kMostPixelClasses = 31;

/** Depth in millimeters, color, and one label bit a pixel: the bit of class i is i. Labels and
 * color belong to the pixels of the depth image. \param classes of the labels, at most
 * kMostPixelClasses */
mrpt::obs::CObservation3DRangeScan::Ptr rangeScan(
    const synthetic_world::CameraFrame& frame, const synthetic_world::CameraOptions& options,
    const Eigen::Isometry3d& T_robot_camera,
    const synthetic_world::ClassTable& classes = synthetic_world::classTable());

/** \param classes of the labels */
labeled_cloud::CObservationLabeledCloud::Ptr labeledCloud(
    synthetic_world::LabeledCloud cloud, const Eigen::Isometry3d& T_robot_lidar,
    const synthetic_world::ClassTable& classes = synthetic_world::classTable());

}  // namespace synthetic_rawlog
