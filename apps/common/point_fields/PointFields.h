#pragma once
#include <labeled_cloud/LabelImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace point_fields {

/** A number among bytes, lowest byte first, or the other way round. */
template <class T>
T numberAt(const std::uint8_t* place, bool isBigEndian) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), place, sizeof(T));
  if (isBigEndian) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

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

/** A sensor_msgs/PointCloud2 as it came: nothing of it is known to be right. */
struct RawCloud {
  struct Field {
    std::string name;
    std::uint32_t offset = 0;
    int type = 0;  ///< sensor_msgs/PointField's number
  };
  std::vector<Field> fields;
  std::uint32_t width = 0, height = 0, pointStep = 0, rowStep = 0;
  bool isBigEndian = false;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;  ///< bytes of data
};

/** The points with their classes. Points that are not finite are left out.
 * \param classField its values are raw ids of the table; "rgb" and "rgba" are colors of its classes
 * \param problem what is wrong with the classes, if anything: points are then without
 * \throw std::runtime_error what is wrong with the points: fields are missing or of a type that is
 * none, or the data are too short. */
semantic_types::LabeledCloud cloudOf(const RawCloud& raw, const std::string& classField,
                                     const semantic_types::ClassTable& table, std::string& problem);

/** When each point of cloudOf() was taken, seconds after the message's stamp. The field is "t",
 * "time", "timestamp", "time_stamp", "time_offset" or "offset_time". Whole numbers are nanoseconds,
 * others seconds, since the stamp or since 1970 (then also nanoseconds). Empty: there is no such
 * field, or no reading of it has all points within a second of the stamp. \param stamp seconds
 * since 1970 \throw std::runtime_error as cloudOf() */
std::vector<float> timesOf(const RawCloud& raw, double stamp);

/** A sensor_msgs/LaserScan as it came. */
struct RawLaserScan {
  float firstAngle = 0, angleStep = 0, timeStep = 0, leastRange = 0, mostRange = 0;  ///< rad, s, m
  std::vector<float> ranges;
};

/** The points that its beams met, in its frame. \param times is set to when each was met, seconds
 * after the message's stamp; empty: all at once \param withEmpty beams that met nothing (infinite)
 * have points beyond mostRange */
semantic_types::LabeledCloud cloudOf(const RawLaserScan& raw, std::vector<float>& times,
                                     bool withEmpty = false);

/** Classes of a message's points or pixels by the numbers that they have; each number is looked up
 * once. */
class NumberedClasses {
 public:
  /** \param areColors numbers are 0xRRGGBB, otherwise raw ids */
  NumberedClasses(const semantic_types::ClassTable& table, bool areColors)
      : m_table(table), m_areColors(areColors) {}

  /** None for a color or a number that the table does not know. */
  semantic_types::ClassId at(double number);
  /** The numbers that it does not know; 0, which is no class unless the table says so, is none. */
  const std::string& problem() const { return m_problem; }

 private:
  semantic_types::ClassId find(double number);

  const semantic_types::ClassTable& m_table;
  bool m_areColors;
  std::map<double, semantic_types::ClassId> m_known;
  double m_last = 0;  ///< number, and its class
  std::optional<semantic_types::ClassId> m_lastClass;
  std::string m_problem;
};

}  // namespace point_fields
