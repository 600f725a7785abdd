#pragma once
#include <semantic_octree/store/ScanGrid.h>

#include <Eigen/Core>
#include <cstddef>

namespace semantic_octree {

/** Sets the bits of the voxels that rays from one point pass, the first one included, the one in
 * which a ray ends left out (Amanatides, Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing").
 * \param begin, ends voxel units relative to the grid, inside it */
void markRays(ScanGrid& grid, const Eigen::Array3d& begin, const Eigen::Array3d* ends,
              std::size_t numRays);

}  // namespace semantic_octree
