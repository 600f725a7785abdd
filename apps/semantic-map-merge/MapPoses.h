#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <vector>

namespace semantic_map_merge {

/** Poses of maps in the frame of their sum, from a file of lines
 *
 *     MAP x y z yaw pitch roll
 *
 * (meters, degrees; empty lines and what follows '#' are skipped). MAP is a path of the command
 * line, or its file name. Maps that it does not name stay where they are.
 * \throw std::runtime_error naming line and text: not such a line, a map that is none or several of
 * the command line's, or named before. */
std::map<std::filesystem::path, Eigen::Isometry3d> readMapPoses(
    const std::filesystem::path& file, const std::vector<std::filesystem::path>& maps);

}  // namespace semantic_map_merge
