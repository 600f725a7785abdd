#pragma once
#include <map_operations/SmoothedView.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>

#include <filesystem>
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
  /** The ground is flat and at this height, m; `ground` is then of no use. */
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

// Points: one for each leaf of the map, its center and what the map knows about it, in a binary PLY
// file or as comma-separated values.

struct PointOptions {
  /** Free leaves too, of which there are many; otherwise occupied ones only. */
  bool free = false;
  /** The class of an occupied leaf is seen together with its neighbors'; by default it is not. */
  semantic_octree::SmoothingOptions smoothing{0};
};

/** Writes a binary PLY file, with vertices of
 *
 *     float x y z                  center, m
 *     uchar red green blue         color of the likeliest class; gray: none was ever seen
 *     uchar class                  its id, 0: none
 *     float probability            of this class
 *     float occupancy              p(occupied)
 *     float size                   edge of the leaf, m
 *
 * and a comment "class ID NAME" for each class.
 * \throw std::runtime_error the stream does not take it. */
void writePly(std::ostream& out, const semantic_octree::SemanticOcTree& tree,
              const PointOptions& options = {});

/** Writes the same as comma-separated values, with a line of the columns' names first. Names with
 * commas or quotes are quoted as in RFC 4180. \throw std::runtime_error as above. */
void writeCsv(std::ostream& out, const semantic_octree::SemanticOcTree& tree,
              const PointOptions& options = {});

/** Reads a map of OctoMap's into one of ours: .bt, or .ot with an OcTree or a ColorOcTree. Unlike
 * OctoMap's own functions it checks the whole file first, and prints nothing. In .ot files that
 * semantic_octree::writeColorOcTree() wrote, colors are classes again; other files hold occupancy
 * only (CSemanticOctoMap::occupancyOnly()).
 * \param like A map whose classes (by their colors) and filter are taken instead; may be null
 * \throw std::runtime_error naming the file and what is wrong: missing, no such map, truncated,
 * damaged. */
semantic_octree::SemanticOcTree importOctomapFile(
    const std::filesystem::path& file, const semantic_octree::SemanticOcTree* like = nullptr);

/** Fills a file with a scene for MRPT's viewers (.3Dscene). Unlike the scene's own function it
 * tells when the disk is full. \throw std::runtime_error naming the file. */
void writeScene(const mrpt_compat::Scene& scene, const std::filesystem::path& file);

}  // namespace semantic_map
