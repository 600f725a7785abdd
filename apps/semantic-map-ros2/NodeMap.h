#pragma once
#include <map_streams/MapStream.h>
#include <semantic_octree/MapFollower.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/Mapper.h>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

/** \file
 * What nodes do with a map, whatever middleware they speak. */

namespace semantic_map_ros2 {

/** The robot is where a person says: x, y and heading of a pose; height and tilt stay. */
void relocalize(semantic_slam::Mapper& mapper, const Eigen::Isometry3d& T_map_said,
                const Eigen::Isometry3d& T_odometry_robot);

/** A point of `~/occupied`, as sensor_msgs/PointCloud2 has it. */
struct PackedPoint {
  float x, y, z;
  std::uint32_t rgb, label;
  float probability;  ///< of the class; without one, of being occupied
};
static_assert(sizeof(PackedPoint) == 24, "as the fields say");
/** Names of its fields, four bytes each, and their numbers of sensor_msgs/PointField. */
const std::array<std::pair<std::string, std::uint8_t>, 6>& fieldsOfPoint();

/** The occupied voxels of a map, as it changes. */
class OccupiedVoxels {
 public:
  using ClassId = semantic_types::ClassId;
  struct Voxel {
    std::uint16_t x, y, z;
    ClassId classId;
    float probability;
    bool looksLike(const Voxel& o) const {
      return x == o.x && y == o.y && z == o.z && classId == o.classId;
    }
  };
  /** Voxels of a cube of 64 x 64 x 64, by tile. */
  using Block = std::map<std::uint64_t, std::vector<Voxel>>;

  /** \param map must outlive it */
  explicit OccupiedVoxels(semantic_octree::SemanticOcTree& map);

  /** Follows the map, which is not to change meanwhile. \return numbers of the blocks that look
   * different now */
  std::set<std::uint64_t> follow();
  /** By their numbers; none is empty. */
  const std::map<std::uint64_t, Block>& blocks() const { return m_blocks; }
  std::array<double, 3> centerOf(const Voxel& voxel) const;
  std::vector<PackedPoint> points() const;

 private:
  std::vector<Voxel> read(const octomap::OcTreeKey& tile) const;

  semantic_octree::SemanticOcTree& m_map;
  semantic_octree::MapFollower m_follower;
  std::map<std::uint64_t, Block> m_blocks;
};

/** Tells a map's compressed tree to those who keep a copy, by semantic_octree::TreeBroadcast. */
class TreeTeller {
 public:
  /** The id of its messages, octomap_msgs/Octomap. */
  static const std::string kId;
  static constexpr int kMostChanges = 100;  ///< that wait for readers that are slow
  using Write = std::function<void(std::string data)>;

  /** \param map must outlive it */
  explicit TreeTeller(semantic_octree::SemanticOcTree& map) : m_map(map) {}
  /** Makes nothing that nobody reads. The map is not to change meanwhile.
   * \param change to whoever listens \param all null, unless somebody came who has nothing yet
   * \throw std::logic_error the map has no abstraction */
  void tell(bool isRead, const Write& change, const Write& all);

 private:
  semantic_octree::SemanticOcTree& m_map;
  std::optional<semantic_octree::TreeBroadcast> m_broadcast;  ///< while somebody reads
};

}  // namespace semantic_map_ros2
