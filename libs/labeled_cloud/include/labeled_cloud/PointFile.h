#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace labeled_cloud {

/** The points of a PCD file, each with the number that one of the file's fields gives it. */
struct PointFile {
  /** In the file's frame, m; not finite where a sensor saw nothing. */
  std::vector<Eigen::Vector3d> points;
  /** As many as points, or none if no field was asked for. */
  std::vector<std::uint32_t> labels;
  /** Where the sensor stood, in the file's frame: VIEWPOINT. */
  Eigen::Isometry3d T_file_sensor = Eigen::Isometry3d::Identity();
};

/** Reads PCD (ascii, binary). x, y, z and the label are fields of any number type; labels are
 * whole.
 * \param labelField the field of the labels; empty: none is read
 * \throw std::runtime_error naming file and value (and line or point) of what is malformed, missing
 * or announced and not there. */
PointFile readPointFile(const std::filesystem::path& file, const std::string& labelField = "label");

}  // namespace labeled_cloud
