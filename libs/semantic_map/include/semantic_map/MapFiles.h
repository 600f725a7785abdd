#pragma once
#include <mrpt_compat/Drawing.h>
#include <semantic_octree/SemanticOcTree.h>

#include <filesystem>
#include <iosfwd>

namespace semantic_map {

// Points: one for each leaf of the map, its center and what the map knows about it, in a binary PLY
// file or as comma-separated values.

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
 * \param free Free leaves too, of which there are many; otherwise occupied ones only.
 * \throw std::runtime_error the stream does not take it. */
void writePly(std::ostream& out, const semantic_octree::SemanticOcTree& tree, bool free = false);

/** Writes the same as comma-separated values, with a line of the columns' names first. Names with
 * commas or quotes are quoted as in RFC 4180. \throw std::runtime_error as above. */
void writeCsv(std::ostream& out, const semantic_octree::SemanticOcTree& tree, bool free = false);

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
