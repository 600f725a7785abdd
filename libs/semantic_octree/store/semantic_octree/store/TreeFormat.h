#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/NodeStore.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace semantic_octree {

/** The CRC-32 of bytes behind others that have this one. */
std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size);

/** As loadTree(). \param checksum becomes that of the file */
SemanticOcTree loadTreeFile(const std::string& path, std::uint32_t* checksum = nullptr);
/** As saveTree(), but not yet on the disk. \return the file's checksum */
std::uint32_t saveTreeFile(const SemanticOcTree& tree, const std::string& path);

/** A tile's file: a map of nothing but one inner node above the blocks, and its ancestors; not yet
 * on the disk. \param nodes below it \return the file's checksum
 * \throw std::runtime_error naming the file */
std::uint32_t saveTile(const SemanticOcTree& tree, const Slot& octant, const Cube& cell,
                       std::uint64_t nodes, const std::string& path);
/** What saveTile() wrote of a map that is like this one: adds the children of an octant that has
 * none. If it fails, some of them may be there. \return the file's checksum
 * \throw std::runtime_error naming the file */
std::uint32_t loadTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant,
                       const Cube& cell, const std::string& path);

}  // namespace semantic_octree
