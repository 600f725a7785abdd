#pragma once
#include <semantic_navigation/Navigator.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <optional>
#include <string>
#include <vector>

#include "Complaints.h"
#include "Parameters.h"
#include "ground_costs/GroundCosts.h"
#include "ros2/Node.h"

namespace semantic_map_ros2 {

/** `map`: GroundCosts as messages. Who reads `map_updates`, too, is told what changed. */
class GroundGrid {
 public:
  /** Node and costs' map must outlive it. */
  GroundGrid(ros2::Node& node, ground_costs::GroundCosts costs, std::string frame)
      : m_costs(std::move(costs)),
        m_frame(std::move(frame)),
        m_writes(node, "map", {true, true, 1}),
        m_writesUpdates(node, "map_updates", {true, false, 10}) {}

  /** Somebody came who has nothing yet. */
  bool isAsked() { return m_writes.hasNewReader(); }
  /** If anybody reads it, and it changed. */
  void publish(ros2::Stamp stamp, const Eigen::Isometry3d& T_map_robot);

 private:
  using Box = ground_costs::GroundCosts::Box;
  void publishAll(const ros2::Header& header);
  void publishUpdate(const ros2::Header& header, const Box& changed);

  ground_costs::GroundCosts m_costs;
  std::string m_frame;
  std::optional<Box> m_box;  ///< that was published
  ros2::Publication<ros2::OccupancyGrid> m_writes;
  ros2::Publication<ros2::OccupancyGridUpdate> m_writesUpdates;
};

/** What becomes of goals: paths (`plan`) and, if the robot drives, commands (`cmd_vel`). */
class Driving {
 public:
  /** All must outlive it. With `drive` the navigator is who inserts scans. */
  Driving(ros2::Node& node, const Parameters& parameters, semantic_slam::Mapper& mapper,
          const colored_graph::ClassOrder& order);

  /** Null unless the robot drives. */
  semantic_navigation::Navigator* navigator() { return m_navigator ? &*m_navigator : nullptr; }
  /** Map frame. */
  void setGoal(const mrpt::math::TPose2D& goal);
  /** Looks around from now on by what the abstraction's weights ask for, without weights for the
   * nearest border of what is known; or ends that. \return why it cannot, if so */
  std::string explore(bool isToExplore);
  /** Who explores looks by the sensor that sees most. */
  void learnSensor(const semantic_slam::SensorScan& scan);
  /** The map changed: without `drive`, plans anew to the goal, if there is one. */
  void plan(const Eigen::Isometry3d& T_map_robot, ros2::Stamp stamp);
  /** Ten times a second, with `drive`. \param robot none: it is not known where it is, and stands
   */
  void step(const std::optional<semantic_navigation::RobotState>& robot, ros2::Stamp stamp);
  /** The robot stands. */
  void halt();

 private:
  void publish(const std::vector<semantic_planning::PathPoint>& path, ros2::Stamp stamp);
  void sayStatus();

  semantic_slam::Mapper& m_mapper;
  std::optional<tree_abstraction::AbstractionWeights> m_weights;  ///< of what is explored for
  semantic_driving::ExploreOptions m_exploring;  ///< its sensor's height is above the frame
  double m_solidAngle = 0;                       ///< of its sensor; 0: nothing was seen yet
  colored_graph::ClassOrder m_order;
  semantic_planning::PlannerOptions m_options;
  std::string m_frame;
  std::optional<semantic_navigation::Navigator> m_navigator;
  std::optional<semantic_planning::SemanticPlanner> m_planner;  ///< after the first goal
  std::optional<mrpt::math::TPose2D> m_goal;                    ///< of the planner
  semantic_planning::FrameHeight m_height;
  bool m_isNew = false, m_moves = false;
  std::string m_said;
  std::vector<semantic_planning::PathPoint> m_published;
  ros2::Publication<ros2::Path> m_writesPath;
  std::optional<ros2::Publication<ros2::Twist>> m_writesCommand;
};

/** Heading, x and y of a pose in space. */
mrpt::math::TPose2D planar(const Eigen::Isometry3d& T);

}  // namespace semantic_map_ros2
