#pragma once
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace semantic_map_ros2 {

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
 * \param problem what is wrong with the classes, if anything: the points are then without
 * \throw std::runtime_error what is wrong with the points: fields are missing or of a type that is
 * none, or the data are too short. */
semantic_types::LabeledCloud cloudOf(const RawCloud& raw, const std::string& classField,
                                     const semantic_types::ClassTable& table, std::string& problem);

/** Class of a pixel or point by a color, or none. */
semantic_types::ClassId classOfColor(semantic_types::Color color,
                                     const semantic_types::ClassTable& table);

}  // namespace semantic_map_ros2
