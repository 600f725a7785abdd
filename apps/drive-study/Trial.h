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
  std::string reason;              ///< why it did not arrive
  double seenAt = -1;              ///< s: a sensor saw the goal's place first; never: negative
  double refusedAt = -1;           ///< s: it said that the goal does not fit
  std::size_t explored = 0;        ///< frontiers
  double seconds = 0, length = 0;  ///< of the drive, m
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

  /** That there is no path to the goal. */
  bool saidSo() const {
    return end == simulated_drive::DriveEnd::Unreachable ||
           end == simulated_drive::DriveEnd::Nearest;
  }
  /** What is not as it has to be; empty: nothing. */
  std::string fault() const;
};

/** Drives a task in a world, from an empty map. \param world is without barriers afterwards */
Trial runTrial(const simulated_drive::DriveConfig& config, synthetic_world::World& world,
               const colored_graph::ClassOrder& order, const Task& task);

}  // namespace drive_study
