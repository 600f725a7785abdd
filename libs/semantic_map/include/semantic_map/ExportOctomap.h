#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <iosfwd>

/** \file
 * The map's occupancy in OctoMap's file formats, node by node: the same resolution, leaves
 * and log-odds. A log-odds of exactly 0, which OctoMap takes for occupied, becomes the next smaller
 * number. */

namespace semantic_map {

/** Writes an .ot file that holds a ColorOcTree: occupied leaves in the color of their likeliest
 * class (gray: none), inner nodes in the mean of their children; free leaves have no color.
 * \throw std::runtime_error the stream does not take it. */
void writeColorOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

/** Writes an .ot file that holds an OcTree. \throw std::runtime_error as above. */
void writeOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

/** Writes a .bt file: whether a leaf is free or occupied is all that it keeps.
 * \throw std::runtime_error as above. */
void writeBinaryOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

}  // namespace semantic_map
