#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <synthetic_world/World.h>

namespace drive_study {

/** The map that a robot would have that had seen the whole world from everywhere, without noise:
 * the ground, and what of the things on it is lower than a vehicle.
 * \param voxelSize meters \param height of the vehicle, meters */
semantic_octree::SemanticOcTree trueMap(const synthetic_world::World& world, double voxelSize,
                                        double height);

}  // namespace drive_study
