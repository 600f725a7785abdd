#pragma once
#include <semantic_map/MapOptions.h>
#include <semantic_navigation/Navigator.h>
#include <semantic_slam/SlamOptions.h>
#include <strict_files/OptionList.h>

#include <filesystem>
#include <string>
#include <utility>
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
  /** An occupancy of 0 to 100 for each rank; none: evenly.
   * \throw std::invalid_argument other numbers, or not as many as there are ranks */
  std::vector<int> costsOf(int ranks) const;
};

/** All that parameters say: those of the node without a section, others as sections of the .ini
 * files of rawlog2semantic-map and semantic-map-drive have them, "insertion.max_range". */
struct Parameters {
  NodeOptions node;
  semantic_map::TCreationOptions map;
  semantic_map::TInsertionOptions insertion;
  semantic_map::TAbstractionOptions abstraction;
  semantic_slam::SlamOptions slam;
  semantic_navigation::NavigatorOptions navigation;  ///< planner, drive, guide, obstacles ...

  semantic_slam::MapperOptions mapping() const;
  /** An empty map. \throw std::runtime_error naming the file of classes that cannot be read. */
  semantic_octree::SemanticOcTree newMap() const;
  /** Has a map keep the abstraction that they ask for, if any. */
  void abstract(semantic_octree::SemanticOcTree& map) const;
};

/** \param files of parameters (YAML), below `ros__parameters` as ROS has them, or plain; files that
 * they name are relative to them \param values by their names; they go before files \throw
 * std::runtime_error naming file, parameter and value. */
Parameters readParameters(const std::vector<std::filesystem::path>& files,
                          const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace semantic_map_ros2
