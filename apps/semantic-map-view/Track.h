#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace semantic_map_view {

/** Where a robot was, or is to go. */
struct Track {
  enum class Gear { Unknown, Forward, Backward };
  struct Point {
    Eigen::Vector3d place;  ///< m, map frame
    Gear gear;              ///< of the way to it
  };
  std::string name;
  std::vector<Point> points;

  double length() const;  ///< m
};

/** By its name's ending, whether a file is one of these, and no map. */
bool isTrack(const std::filesystem::path& file);

/** A trajectory in the format of the TUM data sets (.tum, .txt), or a CSV file with columns x, y
 * and z. In the latter gear ("forward" or "backward") or the sign of speed says which way it goes.
 * semantic-map-plan and semantic-map-drive write such files.
 * \throw std::runtime_error naming file, line and value: it cannot be read, or is no such file. */
Track readTrack(const std::filesystem::path& file);

}  // namespace semantic_map_view
