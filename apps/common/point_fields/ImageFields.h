#pragma once
#include <labeled_cloud/LabelImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semantic_types/ClassTable.h>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace point_fields {

/** A sensor_msgs/Image as it came: nothing of it is known to be right. */
struct RawImage {
  std::uint32_t width = 0, height = 0, step = 0;
  std::string encoding;
  bool isBigEndian = false;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;  ///< bytes of data
};

/** A sensor_msgs/CameraInfo as it came. */
struct RawCamera {
  std::uint32_t width = 0, height = 0;
  std::string model;               ///< of the distortion
  std::vector<double> distortion;  ///< d
  std::array<double, 9> matrix{};  ///< k
};

/** Whether pixels may be depths: 16UC1, mono16 (mm) or 32FC1 (m). */
bool mayBeDepth(const std::string& encoding);

/** A depth image with its calibration, in millimeters; 0 is no return.
 * \throw std::runtime_error another encoding, data that are too short, or a calibration that is
 * another image's or not known here */
mrpt::obs::CObservation3DRangeScan depthOf(const RawImage& image, const RawCamera& camera);

/** A class for each pixel: mono8, mono16, 8UC1, 16UC1 have raw ids of the table, rgb8 and bgr8 its
 * colors. \param problem what is wrong with the classes, if anything: such pixels are without
 * \throw std::runtime_error another encoding, or data that are too short */
labeled_cloud::LabelImage labelsOf(const RawImage& image, const semantic_types::ClassTable& table,
                                   std::string& problem);

/** MRPT's cameras look along x, ROS's optical frames along z. */
Eigen::Isometry3d T_optical_camera();

}  // namespace point_fields
