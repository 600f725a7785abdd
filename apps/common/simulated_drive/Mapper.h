#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <map_correction/KeyframeMap.h>
#include <map_folders/MapFolder.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_slam/Slam.h>

#include "SimulatedSensors.h"

namespace simulated_drive {

/** The robot's map and the planner on it. */
class Mapper {
 public:
  /** Begins with an empty map. */
  Mapper(const DriveConfig& config, const colored_graph::ClassOrder& order);
  /** Goes on with a map, which changes. */
  Mapper(const DriveConfig& config, const colored_graph::ClassOrder& order,
         std::unique_ptr<semantic_octree::StoredMap> map);

  /** \return milliseconds of insert (with the compressed tree's upkeep) and of update (ground and
   * roadmap) */
  semantic_planning::StageTimes insert(const std::vector<Observation>& seen,
                                       const Eigen::Isometry3d& T_map_robot);
  /** Time passes: what has a half-life is forgotten. */
  void age(double seconds) { m_map.age(seconds); }
  /** Inserts what begins a keyframe, and each third scan where none begins: what stands in the way
   * may come and go while the robot waits. Moves keyframes when a loop was closed, but not those of
   * a map with which it began.
   * \param added what became of it in slam */
  semantic_planning::StageTimes insert(const std::vector<Observation>& seen,
                                       const semantic_slam::Slam::Added& added,
                                       const semantic_slam::Slam& slam);

  /** p(x) of the compressed tree from now on, see semantic_driving::regionsAhead(). */
  void focus(const std::vector<semantic_octree::Region>& regions);
  /** The compressed tree as a map. */
  semantic_octree::SemanticOcTree compressed();
  std::size_t numCompressedLeaves();
  /** As senseObstacles(), of the full or the compressed tree. */
  semantic_driving::ObstaclePoints obstacles(const mrpt::math::TPose2D& pose, double z,
                                             const semantic_driving::ObstacleOptions& options,
                                             bool ofFullTree);

  const semantic_octree::SemanticOcTree& map() const { return m_map; }
  semantic_planning::SemanticPlanner& planner() { return m_planner; }
  const semantic_planning::SemanticPlanner& planner() const { return m_planner; }

 private:
  void standOn(const Eigen::Isometry3d& T_map_robot);

  DriveConfig m_config;
  std::unique_ptr<semantic_octree::StoredMap> m_stored;
  semantic_octree::SemanticOcTree& m_map;
  semantic_octree::LeafFollower m_follower;
  std::unique_ptr<semantic_octree::KeyframeMap> m_keyframes;  ///< if the map may be corrected
  int m_leftOut = 0;  ///< scans since the last that was inserted
  semantic_planning::SemanticPlanner m_planner;
  bool m_stands = false;  ///< standOn() was called
};

}  // namespace simulated_drive
