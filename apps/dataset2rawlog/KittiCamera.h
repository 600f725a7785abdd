#pragma once
#include <mrpt/obs/CObservationImage.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

namespace dataset2rawlog {

/** The left color camera of a sequence in KITTI's layout: `P2` of calib.txt and image_2/. Its
 * images stay files of their own, copied beside the rawlog. */
class KittiCamera {
 public:
  /** \param rawlog Where images go: X_Images for X.rawlog. Created if need be.
   * \throw std::runtime_error naming the file and what is missing or malformed. */
  KittiCamera(const std::filesystem::path& sequence, const Eigen::Isometry3d& T_camera0_lidar,
              const std::filesystem::path& rawlog);

  /** The image of this name. \throw std::runtime_error naming a file that is
   * missing or no image. */
  mrpt::obs::CObservationImage observe(const std::string& name, mrpt::Clock::time_point time);

 private:
  std::filesystem::path m_source, m_target;
  mrpt::img::TCamera m_camera;
  mrpt::poses::CPose3D m_T_lidar_camera;
};

}  // namespace dataset2rawlog
