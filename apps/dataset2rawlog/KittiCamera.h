#pragma once
#include <mrpt/obs/CObservationImage.h>
#include <strict_files/OutputFiles.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace dataset2rawlog {

/** The folder of the images of a rawlog: X_Images for X.rawlog. */
std::filesystem::path imagesOf(const std::filesystem::path& rawlog);

/** The left color camera of a sequence in KITTI's layout: `P2` of calib.txt and image_2/. Its
 * images stay files of their own, copied beside the rawlog. */
class KittiCamera {
 public:
  /** \param rawlog Images go into imagesOf(rawlog), in finish().
   * \throw std::runtime_error naming the file and what is missing or malformed. */
  KittiCamera(const std::filesystem::path& sequence, const Eigen::Isometry3d& T_camera0_lidar,
              const std::filesystem::path& rawlog);

  /** The image of this name. \throw std::runtime_error naming a file that is
   * missing or no image. */
  mrpt::obs::CObservationImage observe(const std::string& name, mrpt::Clock::time_point time);
  /** Puts the images that were observed beside the rawlog. \throw std::runtime_error naming one */
  void finish() { m_target.commit(m_names); }

 private:
  std::filesystem::path m_source;
  strict_files::OutputFolder m_target;
  std::vector<std::string> m_names;
  mrpt::img::TCamera m_camera;
  mrpt::poses::CPose3D m_T_lidar_camera;
};

}  // namespace dataset2rawlog
