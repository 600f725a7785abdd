#pragma once
#include <strict_files/OptionList.h>

#include <string>
#include <vector>

namespace semantic_map_ros2 {

/** What concerns ROS 2 alone. */
struct NodeOptions {
  std::string classField = "label";
  std::string mapFrame = "map", odomFrame = "odom", baseFrame = "base_link";
  bool useSimTime = false;
  bool slam = false;              ///< scans are registered to each other
  bool drive = false;             ///< the robot drives to goals
  double transformTimeout = 0.5;  ///< s
  double publishPeriod = 1;       ///< s
  std::string order;              ///< file of the order of classes; empty: no grid, no paths
  std::string costs;              ///< by rank, with commas between; empty: evenly from 0 to 90

  /** In which it is known where the robot is. */
  const std::string& worldFrame() const { return slam ? odomFrame : mapFrame; }

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
  /** An occupancy of 0 to 100 for each rank.
   * \throw std::invalid_argument other numbers, or not as many as there are ranks */
  std::vector<int> costsOf(int ranks) const;
};

}  // namespace semantic_map_ros2
