#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

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
  using Keys = std::array<int, 3>;
  struct Voxel {
    std::uint16_t x, y, z;
    ClassId classId;
    float probability;  ///< of the class; without one, of being occupied
    /** In markers. */
    bool looksLike(const Voxel& o) const {
      return x == o.x && y == o.y && z == o.z && classId == o.classId;
    }
  };
  void follow();
  void read(const octomap::OcTreeKey& tile);
  ros2::Point centerOf(const Voxel& voxel) const;
  void publishMarkers(ros2::Stamp stamp);
  void addMarkers(std::uint64_t block, const ros2::Header& header);
  void publishPoints(ros2::Stamp stamp);
  void publishOctomap(ros2::Stamp stamp);

  semantic_octree::SemanticOcTree& m_map;
  std::string m_frame;
  semantic_octree::MapFollower m_follower;
  std::unordered_map<std::uint64_t, std::vector<Voxel>> m_tiles;
  /** Tiles by the block that they are in, of those that hold voxels. */
  std::map<std::uint64_t, std::set<std::uint64_t>> m_blocks;
  std::set<std::uint64_t> m_changed;                   ///< blocks that markers do not show yet
  std::map<std::uint64_t, std::set<ClassId>> m_shown;  ///< by block
  std::vector<ros2::Marker> m_markers;                 ///< of a message that is made
  std::map<std::pair<std::uint64_t, ClassId>, std::vector<ros2::Point>> m_cubes;  ///< of it
  ros2::Publication<ros2::MarkerArray> m_writesMarkers;
  ros2::Publication<ros2::PointCloud2> m_writesPoints;
  ros2::Publication<ros2::Octomap> m_writesOctomap;
};

}  // namespace semantic_map_ros2
