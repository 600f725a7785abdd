#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include "LabeledFrame.h"

/** How well a map answers labeled points. */
struct MapQuality {
  std::size_t points = 0;    ///< asked
  std::size_t occupied = 0;  ///< of those, in occupied voxels
  std::size_t right = 0;     ///< of those, with the voxel's likeliest class

  /** Share of the points that fall into occupied voxels. */
  double coverage() const { return static_cast<double>(occupied) / static_cast<double>(points); }
  /** Share of the points in occupied voxels that have the voxel's class. */
  double accuracy() const { return static_cast<double>(right) / static_cast<double>(occupied); }
};

/** Asks the map for every point of a frame that has a class, does not move and lies within RANGE
 * meters of the sensor. */
void judge(const semantic_octree::SemanticOcTree& map, const LabeledFrame& frame, double range,
           MapQuality& quality);
