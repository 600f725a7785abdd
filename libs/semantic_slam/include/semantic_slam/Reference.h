#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_slam/Registration.h>

#include <vector>

namespace semantic_slam {

/** A map that is there already, for scans to be registered to: the middles of its occupied voxels,
 * map frame. Leaves larger than the smallest cube say nothing of surfaces and are left out.
 * \param cellSizes edges of cubes, meters \param useClasses false: all points are of one class */
std::vector<Submap> referenceOf(const semantic_octree::SemanticOcTree& map,
                                const std::vector<double>& cellSizes, bool useClasses);

/** Standard deviation of the middle of a voxel as a surface's place, m: more points do not make it
 * less. \param voxelSize meters */
double deviationOfVoxels(double voxelSize);

}  // namespace semantic_slam
