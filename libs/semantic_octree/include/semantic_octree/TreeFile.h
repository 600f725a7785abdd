#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <iosfwd>

namespace semantic_octree {

/** Saves a map: resolution, pruning, filter parameters, class table with its folds, and each node's
 * values bit for bit. The file is written beside and renamed: one that was there stays if this
 * fails. \throw std::runtime_error naming the file and what is wrong. */
void saveTree(const SemanticOcTree& tree, const std::string& path);

/** Loads a map, all of it or nothing.
 * \throw std::runtime_error naming the file and what is wrong: missing, no map, of a newer version,
 * truncated, altered (each byte is covered by a checksum). */
SemanticOcTree loadTree(const std::string& path);

/** Writes the file's bytes to a stream that may hold other things before and after.
 * \throw std::runtime_error the stream does not take them. */
void writeTree(std::ostream& out, const SemanticOcTree& tree);

/** Bytes that writeTree() writes. */
std::size_t fileSize(const SemanticOcTree& tree);

/** Reads what writeTree() wrote and not a byte more.
 * \throw std::runtime_error saying what is wrong; memory taken is bounded by what could be read. */
SemanticOcTree readTree(std::istream& in);

}  // namespace semantic_octree
