#pragma once
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation.h>
#include <synthetic_world/Objects.h>

#include <Eigen/Geometry>
#include <vector>

namespace synthetic_rawlog {

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

}  // namespace synthetic_rawlog
