#pragma once
#include <colored_graph/ClassOrder.h>
#include <semantic_planning/ground/GroundOptions.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <vector>

namespace semantic_planning {

/** Vehicle and options in voxels. */
struct GroundShape {
  GroundShape(const VehicleOptions& vehicle, const GroundOptions& options,
              const colored_graph::ClassOrder& order, double voxelSize);

  int height;      ///< free voxels above a surface
  int step;        ///< from column to column
  double fillGap;  ///< between the surfaces on both sides
  double widestGap;
  double rise;   ///< of a drivable slope, voxels per voxel
  int baseline;  ///< columns to each side over which slope is measured
  int largestClearance;
  std::vector<colored_graph::Rank> ranks;  ///< by class id
  std::vector<bool> keepOff;
};

}  // namespace semantic_planning
