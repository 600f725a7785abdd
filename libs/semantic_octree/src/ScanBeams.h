#pragma once
#include <semantic_octree/InsertionOptions.h>
#include <semantic_types/LabeledCloud.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "Cell.h"

namespace semantic_octree {

/** End of one beam, in voxel units of the map (coordinate / resolution). */
struct BeamEnd {
  Eigen::Array3d end;
  std::uint32_t point;  ///< index into the cloud
  bool isReturn;        ///< false: the return lies beyond the maximum range, this end is clipped
};

/** A scan's beams in the map's frame, and the box of voxels that they cross. */
struct ScanBeams {
  Eigen::Array3d origin;  ///< sensor, voxel units
  std::vector<BeamEnd> ends;
  VoxelIndex lowest, highest;  ///< inclusive
  InsertionReport report;

  /** Transforms a cloud and sorts out what cannot be used.
   * \throw std::out_of_range the sensor lies outside the map. */
  void compute(const semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor,
               double resolution, const InsertionOptions& options);
};

}  // namespace semantic_octree
