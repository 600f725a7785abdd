#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>
#include <strict_files/OptionList.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/World.h>

#include <map>
#include <string>
#include <vector>

#include "simulated_drive/DriveLoop.h"

namespace drive_study {

/** A start and a goal, and what somebody who knows the whole world says of it. */
struct Task {
  mrpt::math::TPose2D start, goal;
  bool hasPath = false;
  std::string reason;                  ///< why not
  double length = 0;                   ///< of the path, meters
  std::vector<double> lengthPerClass;  ///< of the path, meters over the true ground
};

struct TaskOptions {
  double nearest = 15, farthest = 35;  ///< from start to goal, meters
  double clearance = 0.5;              ///< around the footprint at start and goal, meters
  std::uint64_t seed = 1;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** The map of a robot that has seen the whole world from everywhere, without noise. It has the
 * ground, and of the things on it what is lower than a vehicle.
 * \param voxelSize meters \param height of the vehicle, meters */
semantic_octree::SemanticOcTree trueMap(const synthetic_world::World& world, double voxelSize,
                                        double height);

/** Draws starts and goals on free, allowed ground of the true world. */
class TaskDraw {
 public:
  /** \throw std::invalid_argument bad options. */
  TaskDraw(const synthetic_world::World& world, const colored_graph::ClassOrder& order,
           const semantic_planning::VehicleOptions& vehicle, const TaskOptions& options);

  /** Without a path. \throw std::runtime_error the world has no such places. */
  Task next();

 private:
  mrpt::math::TPose2D anyPose();
  bool isFree(const mrpt::math::TPose2D& pose) const;

  const synthetic_world::World& m_world;
  const colored_graph::ClassOrder& m_order;
  synthetic_world::Footprint m_footprint;
  TaskOptions m_options;
  synthetic_world::Random m_random;
};

/** Knows the whole world, and plans over it with denser and denser graphs. */
class Oracle {
 public:
  /** \param planner how the robot plans */
  Oracle(const synthetic_world::World& world, const colored_graph::ClassOrder& order,
         const semantic_planning::PlannerOptions& planner, double voxelSize);

  /** Whether the robot could stand at start and goal if it knew everything. */
  bool accepts(const Task& task);
  /** Sets the task's path, or why there is none. */
  void solve(Task& task);

 private:
  semantic_planning::SemanticPlanner& plannerWith(std::size_t vertices);

  const synthetic_world::World& m_world;
  const colored_graph::ClassOrder& m_order;
  semantic_planning::PlannerOptions m_options;
  semantic_octree::SemanticOcTree m_map;
  std::map<std::size_t, semantic_planning::SemanticPlanner> m_planners;
};

/** A task, and how the robot fared. */
struct Trial {
  std::string scene;
  int number = 0;
  Task task;
  simulated_drive::DriveRecord record;
  std::size_t explored = 0;               ///< frontiers
  double badDriven = 0, badFollowed = 0;  ///< m off the best class: driven, and along its paths
  double processorSeconds = 0;

  /** What is not as it has to be; empty: nothing. */
  std::string fault() const;
};

/** Drives a task in a world, from an empty map. */
Trial runTrial(const simulated_drive::DriveConfig& config, synthetic_world::World& world,
               const colored_graph::ClassOrder& order, const Task& task);

/** The task, what comes of its drive, and the fault. */
nlohmann::json toJson(const Trial& trial, const colored_graph::ClassOrder& order);

}  // namespace drive_study
