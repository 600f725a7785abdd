#pragma once
#include <octomap/OcTree.h>

#include <filesystem>
#include <memory>

namespace semantic_map {

/** Reads the occupancy of a map of OctoMap's: .bt, or .ot with an OcTree or a ColorOcTree. Unlike
 * OctoMap's own functions it checks the whole file first, and prints nothing.
 * \throw std::runtime_error naming the file and what is wrong: missing, no such map, truncated,
 * damaged. */
std::unique_ptr<octomap::OcTree> readOctomapFile(const std::filesystem::path& file);

}  // namespace semantic_map
