#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <iosfwd>

/** \file
 * The map in OctoMap's file formats, see map_operations/OctomapConversion.h. */

namespace semantic_map {

/** Writes an .ot file that holds a ColorOcTree. \throw std::runtime_error the stream does not take
 * it. */
void writeColorOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

/** Writes an .ot file that holds an OcTree. \throw std::runtime_error as above. */
void writeOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

/** Writes a .bt file: whether a leaf is free or occupied is all that it keeps.
 * \throw std::runtime_error as above. */
void writeBinaryOcTree(std::ostream& out, const semantic_octree::SemanticOcTree& tree);

}  // namespace semantic_map
