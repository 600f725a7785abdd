#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_driving/DriveGuide.h>
#include <semantic_types/ClassTable.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace simulated_drive {

/** One step of the control. */
struct DriveRow {
  double time = 0;                      ///< s
  mrpt::math::TPose2D pose;             ///< true, map frame
  mrpt::math::TPose2D believed;         ///< where the robot believes to be
  mrpt::math::TPose2D odometry;         ///< where it would without correction
  double z = 0, speed = 0, turn = 0;    ///< m, m/s, rad/s
  semantic_types::ClassId classId = 0;  ///< true ground below the robot
  double clearance = 0;                 ///< m to the nearest true thing, at most 5
  double offset = 0;                    ///< m from the path
  double bend = 0;                      ///< of the path there, 1/m
  semantic_driving::Target target = semantic_driving::Target::None;
  bool isReactive = false;  ///< MRPT's navigator steers
};

/** Explored: it looked around, and that is over. Nearest: it is at the pose nearest to the goal
 * that fits. Astray: it believes to have arrived, but has not. Stopped: the user wanted no more of
 * it. */
enum class DriveEnd { Arrived, Nearest, Astray, Unreachable, TimeLimit, Stopped, Explored };
inline strict_files::Choices<DriveEnd> choicesOf(DriveEnd) {
  return {{"arrived", DriveEnd::Arrived},      {"nearest", DriveEnd::Nearest},
          {"astray", DriveEnd::Astray},        {"unreachable", DriveEnd::Unreachable},
          {"time_limit", DriveEnd::TimeLimit}, {"stopped", DriveEnd::Stopped},
          {"explored", DriveEnd::Explored}};
}
inline const char* nameOf(DriveEnd end) { return strict_files::nameIn(choicesOf(end), end); }

/** A whole drive. */
struct DriveRecord {
  DriveEnd end = DriveEnd::TimeLimit;
  std::string reason;
  std::optional<semantic_driving::RefusedGoal> refusal;  ///< it does not fit
  bool exactPose = true;                                 ///< the robot knows it
  std::vector<DriveRow> rows;
  std::vector<double> drivenPerClass;   ///< m, true ground along the driven way
  std::vector<double> plannedPerClass;  ///< m, true ground along the paths that it followed
  double length = 0;                    ///< m
  int replans = 0, collisions = 0;
  double leastClearance = std::numeric_limits<double>::infinity();  ///< m
  std::vector<double> leaves;  ///< of the compressed tree, after each insertion
  /** Milliseconds of each stage, cycle by cycle. */
  std::map<std::string, std::vector<double>> times;

  /** A step of the control. \param planned true ground below the path there, if there is one
   * \param way driven in it, m */
  void add(const DriveRow& row, std::optional<semantic_types::ClassId> planned, double way);
  bool arrived() const { return end == DriveEnd::Arrived; }
  double duration() const { return rows.empty() ? 0 : rows.back().time; }
};

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
