#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "DriveLoop.h"

namespace simulated_drive {

/** A line for each step of the control. */
std::string toCsv(const DriveRecord& record);

/** What somebody feels who sits in it; rates from step to step of the control. */
struct Smoothness {
  double jerk = 0;              ///< largest, along the way, m/s^3
  double backwards = 0;         ///< m
  double longestBackwards = 0;  ///< m, until it goes ahead again
  /** How often turning (faster than 0.02 rad/s) changes its side; of the paths that it followed, as
   * they were planned; and gears. */
  int turnChanges = 0, pathTurnChanges = 0, gearChanges = 0;
};
Smoothness smoothnessOf(const DriveRecord& record);

/** How far off the robot believes to be, step by step: m; of the heading, degrees. */
struct PoseErrors {
  double mean = 0, largest = 0, meanHeading = 0;
};
/** \param pose DriveRow::believed or DriveRow::odometry */
PoseErrors poseErrorsOf(const DriveRecord& record, mrpt::math::TPose2D DriveRow::*pose);

/** The share of cycles (insert, update, replan) that took more than 100 ms: 0 to 1. */
double shareOfSlowCycles(const DriveRecord& record);

/** What the whole drive comes to. */
nlohmann::json toJson(const DriveRecord& record, const colored_graph::ClassOrder& order);

/** Meters in classes of a rank but the best, and in forbidden ones; of lengths by class id. */
double badLength(const std::vector<double>& perClass, const colored_graph::ClassOrder& order);

}  // namespace simulated_drive
