#pragma once
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace semantic_map {

/** What of a 3D map obstructs a robot on the ground. Heights are of centers of voxels. */
struct GridOptions {
  /** What lies that far above the ground obstructs, m. */
  double low = 0.3, high = 2.0;
  /** Classes that are ground and never obstruct. None: the lowest occupied voxel of each column is
   * taken for ground. */
  std::vector<semantic_types::ClassId> ground;
  /** What stands out of its surroundings is no ground: the ground's surface is opened
   * (morphologically) by a square of this edge, m. It should be wider than cars and narrower than
   * hills. */
  double window = 4;
  /** The ground is flat and at this height, m; the two options above are then of no use. */
  std::optional<double> floor;

  /** All but `ground`. */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** The map's 2D occupancy grid, one cell for each column of voxels:
 *
 * - occupied as the most occupied voxel between `low` and `high` above the ground, if that is
 *   occupied;
 * - free as that voxel, or as surely as the ground below was seen, if the ground was seen or at
 *   least half of the voxels between are known to be free;
 * - otherwise unknown (0.5).
 *
 * \throw std::invalid_argument bad options, or a class that is not in the map
 * \throw std::runtime_error the map is empty or too wide. */
mrpt::maps::COccupancyGridMap2D gridOf(const semantic_octree::SemanticOcTree& tree,
                                       const GridOptions& options = {});

/** Writes a grid as MRPT reads it back (.gridmap). \throw std::runtime_error */
void writeGridMap(std::ostream& out, const mrpt::maps::COccupancyGridMap2D& grid);

/** A grid as ROS's map_server loads it: picture and description. Pixels are black (0) where
 * occupied, white (254) where free, gray (205) where unknown. */
struct MapServerFiles {
  std::string png;   ///< bytes
  std::string yaml;  ///< text
};

/** \param pngName of the picture's file, relative to the YAML file. */
MapServerFiles mapServerFiles(const mrpt::maps::COccupancyGridMap2D& grid,
                              const std::string& pngName);

}  // namespace semantic_map
