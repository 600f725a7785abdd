#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "NodeMap.h"
#include "ros2/Node.h"

namespace semantic_map_ros2 {

/** The occupied voxels of a map for those who look at it: `~/markers` (cubes by class, only where
 * the map changed), `~/occupied` (points) and `~/octomap`. Nothing is made that nobody reads. */
class MapMessages {
 public:
  /** Node and map must outlive it. \param frame of the map */
  MapMessages(ros2::Node& node, semantic_octree::SemanticOcTree& map, std::string frame);

  /** The map is not to change meanwhile. */
  void publish(ros2::Stamp stamp);

 private:
  using ClassId = semantic_types::ClassId;
  void publishMarkers(ros2::Stamp stamp);
  void addMarkers(std::uint64_t block, const ros2::Header& header);
  void publishPoints(ros2::Stamp stamp);
  void publishOctomap(ros2::Stamp stamp);

  semantic_octree::SemanticOcTree& m_map;
  std::string m_frame;
  OccupiedVoxels m_voxels;
  std::set<std::uint64_t> m_changed;                   ///< blocks that markers do not show yet
  std::map<std::uint64_t, std::set<ClassId>> m_shown;  ///< by block
  std::vector<ros2::Marker> m_markers;                 ///< of a message that is made
  std::map<std::pair<std::uint64_t, ClassId>, std::vector<ros2::Point>> m_cubes;  ///< of it
  ros2::Publication<ros2::MarkerArray> m_writesMarkers;
  ros2::Publication<ros2::PointCloud2> m_writesPoints;
  ros2::Publication<ros2::Octomap> m_writesOctomap;
};

}  // namespace semantic_map_ros2
