#pragma once
#include "TileGrid.h"

namespace semantic_octree {

/** Sets the bit of every voxel from `begin`'s up to, but not including, `end`'s. Both in voxel
 * units relative to the grid, inside it.
 *
 * Traversal of Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing" (1987): at
 * each step the axis whose next voxel border is nearest along the ray advances (on a tie z before y
 * before x). */
void markRay(TileGrid& grid, const Eigen::Array3d& begin, const Eigen::Array3d& end);

}  // namespace semantic_octree
