#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <memory>

namespace octomap {
class ColorOcTree;
class OcTree;
}  // namespace octomap

namespace semantic_octree {

/** \file
 * Maps as OctoMap's trees, and back: the same resolution, nodes and log-odds. A log-odds of
 * exactly 0, which OctoMap takes for occupied, becomes the next smaller number. */

/** The occupancy. */
std::unique_ptr<octomap::OcTree> toOcTree(const SemanticOcTree& map);

/** Occupied leaves in the color of their likeliest class (gray: none), inner nodes in the mean of
 * their children; free leaves have no color. */
std::unique_ptr<octomap::ColorOcTree> toColorOcTree(const SemanticOcTree& map);

/** Occupancy, put into the filter's limits; no voxel has a class.
 * \throw std::invalid_argument a map of another number of levels than 16, bad parameters. */
SemanticOcTree fromOcTree(const octomap::OcTree& map, const ClassTable& classes,
                          const FilterParameters& filter = {});

}  // namespace semantic_octree
