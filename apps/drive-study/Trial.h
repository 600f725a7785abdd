#pragma once
#include "Tasks.h"
#include "simulated_drive/DriveFiles.h"
#include "simulated_drive/DriveLoop.h"

namespace drive_study {

/** A task, and how the robot fared. */
struct Trial {
  std::string scene;
  int number = 0;
  Task task;
  simulated_drive::DriveEnd end = simulated_drive::DriveEnd::TimeLimit;
  std::string reason;                     ///< why it did not arrive
  std::size_t explored = 0;               ///< frontiers
  double seconds = 0, length = 0;         ///< of the drive, m
  double badDriven = 0, badFollowed = 0;  ///< m off the best class: driven, and along its paths
  double badBest = 0;                     ///< m off the best class along the task's path
  double leastClearance = 0;              ///< m
  int collisions = 0, replans = 0;
  simulated_drive::Smoothness smooth;
  simulated_drive::PoseErrors poseErrors, odometryErrors;
  /** Milliseconds of the processor to localize, insert, update and replan: median, 95 %. */
  double cycle = 0, slowCycle = 0;
  double leaves = 0;  ///< of the compressed tree, median
  double processorSeconds = 0;

  /** What is not as it has to be; empty: nothing. */
  std::string fault() const;
};

/** Drives a task in a world, from an empty map. */
Trial runTrial(const simulated_drive::DriveConfig& config, synthetic_world::World& world,
               const colored_graph::ClassOrder& order, const Task& task);

/** A line for each drive. */
std::string toCsv(const std::vector<Trial>& trials);

}  // namespace drive_study
