#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace semantic_map_ros2 {

/** A point of `~/occupied`, as sensor_msgs/PointCloud2 has it. */
struct PackedPoint {
  float x, y, z;
  std::uint32_t rgb, label;
  float probability;  ///< of the class; without one, of being occupied
};
static_assert(sizeof(PackedPoint) == 24, "as the fields say");
/** Names of its fields, four bytes each, and their numbers of sensor_msgs/PointField. */
const std::array<std::pair<std::string, std::uint8_t>, 6>& fieldsOfPoint();

/** The centers of a map's occupied voxels between two keys, these included. */
std::vector<PackedPoint> occupiedVoxels(const semantic_octree::SemanticOcTree& map,
                                        const octomap::OcTreeKey& low = {0, 0, 0},
                                        const octomap::OcTreeKey& high = {65535, 65535, 65535});

}  // namespace semantic_map_ros2
