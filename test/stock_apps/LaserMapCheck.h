#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <filesystem>

/** A semantic octree of a laser scanner beside a points map of the same scans (as MRPT saves it, a
 * line "x y z" a point) and the path of the robot ("step x y phi" or more). */
struct LaserMapCheck {
  double pointsInOccupied = 0;  ///< share of the points that lie in an occupied voxel or beside one
  double occupiedAtPoints = 0;  ///< share of occupied voxels with such a point
  double pathInFree = 0;        ///< share of the scanner's places that are free
};

/** \param scanner height of the scanner above the robot, and ahead of it, m */
LaserMapCheck checkLaserMap(const semantic_octree::SemanticOcTree& map,
                            const std::filesystem::path& points, const std::filesystem::path& path);
