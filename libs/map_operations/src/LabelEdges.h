#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace semantic_octree {

/** Voxels by their key, 16 bits for each axis: labels, one of each scan, a byte each. */
using PlacedLabels = std::unordered_map<std::uint64_t, std::string>;

/** How often places are wrong in all scans, as a multiple of how often in one, [0, 1].
 *
 * A place that is taken for another class has an edge: in one scan, between voxels that the other
 * scans call by one class, or in all. The ratio of both is that multiple, for each pair of classes.
 * What is as wrong in all scans by chance does not count. If scans err voxel by voxel and not in
 * patches, no edge in all scans counts.
 * \param classesOf p(class k + 1), given a voxel's labels, if scans err by chance */
double alwaysWrong(const PlacedLabels& voxels,
                   const std::function<std::vector<double>(const std::string&)>& classesOf);

}  // namespace semantic_octree
