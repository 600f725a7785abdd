#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <vector>

namespace octomap {
class ColorOcTree;
class OcTree;
}  // namespace octomap

namespace semantic_octree {

/** \file
 * What comes of maps: new ones, or others that are to be filled. The latter have to be empty
 * and like emptyLike(). They may be in a folder of tiles that is open for writing (MapFolder), and
 * need not fit into memory then. If filling fails they are not to be used. */

/** Fills a map with the nodes of another, to the last bit.
 * \param copy to be filled \throw std::invalid_argument it is not empty, or not like the map. */
void copyTo(SemanticOcTree& copy, const SemanticOcTree& map);

/** Whether a sum of evidence is put into the class filter's limits. */
enum class Limits {
  /** As after an insertion. */
  Apply,
  /** Left as it is, to be added to further maps; the next scan that meets a voxel limits it. */
  Keep
};

/** Adds what maps of one frame know, as if no scan was in two of them: log-odds h_k - prior are
 * summed voxel by voxel.
 *
 * Maps that age (SemanticOcTree::age()) are added as they are now; the sum's clock is the latest of
 * theirs.
 *
 * The order of the maps leaves no trace, not even in the last bit. Neither does grouping if partial
 * sums are made with Limits::Keep and no voxel has more than three named classes. No sum may leave
 * the range of log-odds, 31.99 on either side (four maps of 24 classes that are all as sure as they
 * can be). What is beyond is lowered into the range, all classes alike.
 * \throw std::invalid_argument no maps, or maps that differ in resolution, classes or filter
 * parameters; says which. */
SemanticOcTree merged(const std::vector<const SemanticOcTree*>& maps,
                      Limits limits = Limits::Apply);
/** \param sum to be filled \throw std::invalid_argument also if it is not empty. */
void mergeTo(SemanticOcTree& sum, const std::vector<const SemanticOcTree*>& maps,
             Limits limits = Limits::Apply);

/** The voxels whose centers are in a box (meters, map frame).
 * \throw std::invalid_argument an empty box, or NaN
 * \throw std::length_error it cuts leaves that are too large. */
SemanticOcTree cropped(const SemanticOcTree& map, const Eigen::AlignedBox3d& box);

/** The map with voxels of 2^levels times the edge. A voxel is as occupied as the most occupied
 * one in it, its classes are those of the voxels in it with labels, as in
 * Abstraction::compressedMap. \throw std::invalid_argument levels not 0 to 8. */
SemanticOcTree coarsened(const SemanticOcTree& map, int levels);

/** The map seen from another frame: a voxel takes the state of the one in which its center lies.
 * \param T_new_old pose of the map's frame in the new one
 * \throw std::invalid_argument the pose is not a rigid transformation
 * \throw std::out_of_range a known part of the map would be outside the new one
 * \throw std::length_error it cuts leaves that are too large. */
SemanticOcTree moved(const SemanticOcTree& map, const Eigen::Isometry3d& T_new_old);

/** How much of what is in a map. A leaf above the lowest level counts as all voxels in it, so
 * pruning does not change the numbers. */
struct MapContents {
  std::size_t leaves = 0, innerNodes = 0;
  /** See SemanticOcTree::memoryUsage(). */
  std::size_t bytes = 0;
  std::uint64_t freeVoxels = 0, occupiedVoxels = 0;
  /** K + 1 numbers of occupied voxels by their likeliest class; [0]: no class was ever seen. */
  std::vector<std::uint64_t> voxelsOfClass;
  /** The box around all known voxels, meters, map frame; empty for an empty map. */
  Eigen::AlignedBox3d box;
};

/** Counts; takes one look at each leaf. */
MapContents contentsOf(const SemanticOcTree& tree);

// OctoMap's trees:
// maps become them, and come of them, with the same resolution, nodes and log-odds. A log-odds of
// exactly 0, which OctoMap takes for occupied, becomes the next smaller number.

/** The occupancy. */
std::unique_ptr<octomap::OcTree> toOcTree(const SemanticOcTree& map);

/** Occupied leaves in the color of their likeliest class (gray: none), inner nodes in the mean of
 * their children; free leaves have no color. */
std::unique_ptr<octomap::ColorOcTree> toColorOcTree(const SemanticOcTree& map);

// Files of OctoMap's trees. OctoMap's own functions print what they do.

/** Writes an .ot file that holds a ColorOcTree; comments in its header, "# class R G B NAME", say
 * what the colors mean. \throw std::runtime_error the stream does not take it. */
void writeColorOcTree(std::ostream& out, const SemanticOcTree& map);
/** Writes an .ot file that holds an OcTree. \throw std::runtime_error the stream does not take it.
 */
void writeOcTree(std::ostream& out, const SemanticOcTree& map);
/** Writes a .bt file: whether a leaf is free or occupied is all that it keeps.
 * \throw std::runtime_error the stream does not take it. */
void writeBinaryOcTree(std::ostream& out, const SemanticOcTree& map);

/** Occupancy, put into the filter's limits; no voxel has a class.
 * \throw std::invalid_argument a map of another number of levels than 16, bad parameters. */
SemanticOcTree fromOcTree(const octomap::OcTree& map, const ClassTable& classes,
                          const FilterParameters& filter = {});
/** In an occupied leaf of exactly a class's color a label of that class was seen; its occupancy
 * ends at the filter's limit for a class.
 * \throw std::invalid_argument a map of another number of levels than 16, bad parameters. */
SemanticOcTree fromOcTree(const octomap::ColorOcTree& map, const ClassTable& classes,
                          const FilterParameters& filter = {});

}  // namespace semantic_octree
