#include "NodeOptions.h"

#include <strict_files/Words.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace semantic_map_ros2 {

void NodeOptions::describe(strict_files::OptionList& list) {
  using strict_files::atLeast;
  list.add(
      "class_field", classField, "",
      "field of clouds that holds classes: raw ids of the class table, or `rgb`: colors of it");
  list.add("map_frame", mapFrame, "", "frame of the map, of goals, paths and grids");
  list.add("odom_frame", odomFrame, "", "with `slam`: the frame in which odometry has the robot");
  list.add("base_frame", baseFrame, "", "frame of the robot");
  list.add("use_sim_time", useSimTime, "", "time is what /clock says");
  list.add(
      "slam", slam, "",
      "scans are registered to each other, loops closed, and the transform from `map_frame` to "
      "`odom_frame` is published; without, /tf has the robot in `map_frame`");
  list.add("drive", drive, "", "the robot drives to goals: `cmd_vel`");
  list.add("transform_timeout", transformTimeout, "s", atLeast(0),
           "how long a scan waits for its transforms and labels until it is left out");
  list.add("publish_period", publishPeriod, "s", atLeast(0),
           "the map is published no more often; 0: after each scan");
  list.add("order", order, "", "order of classes (YAML), for `map` and `plan`; empty: neither");
  list.add(
      "costs", costs, "",
      "occupancy of each rank in `map`, 0 to 100, with commas between; empty: evenly from 0 to 90");
}

void NodeOptions::validate() const { strict_files::checkOptions(*this, "NodeOptions"); }

std::vector<int> NodeOptions::costsOf(int ranks) const {
  std::vector<int> all;
  std::istringstream words(costs);
  for (std::string word; std::getline(words, word, ',');) {
    const double cost = strict_files::numberOf(strict_files::trimmed(word));
    if (!(cost >= 0 && cost <= 100) || cost != std::floor(cost))
      throw std::invalid_argument("costs: '" + word + "' is no whole number from 0 to 100");
    all.push_back(static_cast<int>(cost));
  }
  if (all.empty())
    for (int rank = 0; rank < ranks; ++rank) all.push_back(ranks > 1 ? 90 * rank / (ranks - 1) : 0);
  if (all.size() != static_cast<std::size_t>(ranks))
    throw std::invalid_argument("costs: there are " + std::to_string(all.size()) +
                                ", expected one for each of " + std::to_string(ranks) + " ranks");
  return all;
}

}  // namespace semantic_map_ros2
