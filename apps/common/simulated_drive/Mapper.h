#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include "SimulatedSensors.h"

namespace simulated_drive {

/** The robot's map and the planner on it. */
class Mapper {
 public:
  /** Begins with an empty map. */
  Mapper(const DriveConfig& config, const colored_graph::ClassOrder& order);
  /** Goes on with a map. */
  Mapper(const DriveConfig& config, const colored_graph::ClassOrder& order,
         semantic_octree::SemanticOcTree map);

  /** \return milliseconds of insert (with the compressed tree's upkeep) and of update (ground and
   * roadmap) */
  semantic_planning::StageTimes insert(const std::vector<Observation>& seen,
                                       const Eigen::Isometry3d& T_map_robot);

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
  semantic_octree::SemanticOcTree m_map;
  semantic_planning::SemanticPlanner m_planner;
  bool m_stands = false;  ///< standOn() was called
};

}  // namespace simulated_drive
