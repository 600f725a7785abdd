#pragma once
#include <map_operations/SmoothedView.h>

#include <iosfwd>

/** \file
 * One point for each leaf of the map: its center and what the map knows about it. */

namespace semantic_map {

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

}  // namespace semantic_map
