#pragma once
#include <semantic_navigation/Navigator.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <memory>
#include <optional>

#include "Complaints.h"
#include "Parameters.h"
#include "ros2/Node.h"

namespace semantic_map_ros2 {

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
  colored_graph::ClassOrder m_order;
  semantic_planning::PlannerOptions m_options;
  std::string m_frame;
  std::optional<semantic_navigation::Navigator> m_navigator;
  std::optional<semantic_planning::SemanticPlanner> m_planner;  ///< after the first goal
  std::optional<mrpt::math::TPose2D> m_goal;                    ///< of the planner
  bool m_isNew = false, m_moves = false;
  std::string m_said;
  std::vector<semantic_planning::PathPoint> m_published;
  ros2::Publication<ros2::Path> m_writesPath;
  std::optional<ros2::Publication<ros2::Twist>> m_writesCommand;
};

/** Heading, x and y of a pose in space. */
mrpt::math::TPose2D planar(const Eigen::Isometry3d& T);

}  // namespace semantic_map_ros2
