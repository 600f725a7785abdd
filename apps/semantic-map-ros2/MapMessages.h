#pragma once
#include <map_streams/MapStream.h>
#include <semantic_octree/MapFollower.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "OccupiedVoxels.h"
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
  /** What markers show of a block. */
  struct Shown {
    std::size_t hash = 0;
    std::set<ClassId> classes;
  };
  void publishMarkers(ros2::Stamp stamp);
  void addMarkers(int block, const ros2::Header& header);
  void publishPoints(ros2::Stamp stamp);
  void publishOctomap(ros2::Stamp stamp);

  semantic_octree::SemanticOcTree& m_map;
  std::string m_frame;
  semantic_octree::MapFollower m_follower;
  std::set<int> m_changed;              ///< blocks that markers may not show yet
  std::map<int, Shown> m_shown;         ///< by block
  std::vector<ros2::Marker> m_markers;  ///< of a message that is made
  std::map<std::pair<int, ClassId>, std::vector<ros2::Point>> m_cubes;  ///< of it, by block
  ros2::Publication<ros2::MarkerArray> m_writesMarkers;
  ros2::Publication<ros2::PointCloud2> m_writesPoints;
  ros2::Publication<ros2::Octomap> m_writesOctomap;
};

/** A map's compressed tree for those who keep a copy. `~/change` has what changed, `~/compressed`
 * all of it, for who comes late or lost a change. */
class TreeMessages {
 public:
  /** Node and map must outlive it. \param frame of the map */
  TreeMessages(ros2::Node& node, semantic_octree::SemanticOcTree& map, std::string frame);

  /** Somebody came who has nothing yet. */
  bool isAsked() { return m_writesAll.hasNewReader(); }
  bool isRead() const { return m_writesChanges.isRead() || m_writesAll.isRead(); }
  /** The map is not to change meanwhile. Nothing is made that nobody reads.
   * \throw std::logic_error the map has no abstraction */
  void publish(ros2::Stamp stamp);

 private:
  semantic_octree::SemanticOcTree& m_map;
  std::string m_frame;
  std::optional<semantic_octree::TreeBroadcast> m_broadcast;  ///< while somebody reads
  ros2::Publication<ros2::Octomap> m_writesChanges, m_writesAll;
};

/** A copy of the compressed tree that another node publishes. */
class TreeReader {
 public:
  /** \param of the other node's name, "/semantic_map" */
  TreeReader(ros2::Node& node, const std::string& of);

  /** To be called now and then: asks for all of the tree if something is missing.
   * \return what is wrong with a message that came since, if anything is */
  std::string look();
  /** See TreeCopy. Any thread may ask. */
  bool isCurrent() const;
  std::optional<semantic_octree::SemanticOcTree> map() const;

 private:
  using Message = std::shared_ptr<const ros2::Octomap>;
  void take(const Message& message, bool isAll);

  ros2::Node& m_node;
  std::string m_allName;
  mutable std::mutex m_mutex;
  semantic_octree::TreeCopy m_copy;
  bool m_hasMap = false, m_isLacking = true, m_isAnswered = true;  ///< by all of it
  std::string m_problem;
  std::optional<ros2::Subscription<ros2::Octomap>> m_hearsAll;  ///< while something is missing
  ros2::Subscription<ros2::Octomap> m_hearsChanges;
};

}  // namespace semantic_map_ros2
