#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <filesystem>
#include <string>
#include <vector>

namespace semantic_map_edit {

/** A column of a map, from its bottom to its top. Its base is a square of 2^levels voxels, whose
 * lowest corner is at (x, y) edges from the origin. */
struct Tile {
  int x = 0, y = 0;

  /** As files are named: "3_-1.semantic". */
  std::string fileName() const;
  bool operator<(const Tile& o) const { return x != o.x ? x < o.x : y < o.y; }
};

/** Those in which anything is known, each once, in order. \param levels 0 to 15 */
std::vector<Tile> tilesOf(const semantic_octree::SemanticOcTree& map, int levels);

/** Writes each of the tiles as a map of its own.
 * \throw std::runtime_error naming the file that cannot be written; then there are none. */
void saveTiles(const semantic_octree::SemanticOcTree& map, int levels,
               const std::vector<Tile>& tiles, const std::filesystem::path& folder);

}  // namespace semantic_map_edit
