#pragma once
#include <semantic_octree/MapFollower.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <string>
#include <vector>

#include "ros2/Node.h"

namespace semantic_map_ros2 {

/** `map`: what driving over the ground that the robot can reach costs, as nav2's static layer takes
 * it: a rank's cost, 100 where there is another thing or a forbidden class, -1 where the map knows
 * nothing. */
class GroundGrid {
 public:
  /** Node and map must outlive it. \param costs by rank */
  GroundGrid(ros2::Node& node, semantic_octree::SemanticOcTree& map,
             const colored_graph::ClassOrder& order,
             const semantic_planning::PlannerOptions& options, std::vector<int> costs,
             std::string frame);

  /** If anybody reads it. */
  void publish(ros2::Stamp stamp, const Eigen::Isometry3d& T_map_robot);

 private:
  int costAt(semantic_planning::Column column,
             const std::optional<semantic_planning::GroundPoint>& robot) const;

  colored_graph::ClassOrder m_order;
  semantic_octree::MapFollower m_follower;
  semantic_planning::Ground m_ground;
  std::vector<int> m_costs;
  std::string m_frame;
  ros2::Publication<ros2::OccupancyGrid> m_writes;
};

}  // namespace semantic_map_ros2
