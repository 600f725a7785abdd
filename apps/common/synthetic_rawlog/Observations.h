#pragma once
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <vector>

// What the sensors of the synthetic world see, as MRPT's observations.

namespace synthetic_rawlog {

using labeled_cloud::toMrpt;

/** The rawlog of a drive, frame by frame. */
class DriveLog {
 public:
  /** \param odometry Movements and sensory frames; otherwise observations, the true pose first.
   * \param odometryNoise Standard deviation of each movement, as a share of it. */
  DriveLog(const std::filesystem::path& target, bool odometry, double odometryNoise,
           std::uint64_t seed)
      : m_rawlog(target), m_odometry(odometry), m_noise(odometryNoise), m_random(seed) {}

  /** Adds what was seen at one pose at one time. */
  void write(mrpt::Clock::time_point time, const Eigen::Isometry3d& T_map_robot,
             const std::vector<mrpt::obs::CObservation::Ptr>& observations);
  void finish() { m_rawlog.finish(); }

 private:
  void writeMovement(mrpt::Clock::time_point time, const Eigen::Isometry3d& T_map_robot);

  labeled_cloud::RawlogWriter m_rawlog;
  bool m_odometry;
  double m_noise;
  synthetic_world::Random m_random;
  Eigen::Isometry3d m_T_map_before = Eigen::Isometry3d::Identity();
  bool m_started = false;
};

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
