#include "Tiles.h"

#include <semantic_octree/Keys.h>
#include <semantic_octree/MapOperations.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/OutputFolder.h>

#include <limits>
#include <set>

namespace semantic_map_edit {

using semantic_octree::kKeyOfOrigin;
using semantic_octree::kTreeDepth;
using semantic_octree::SemanticOcTree;

namespace {

Eigen::AlignedBox3d boxOf(const Tile& tile, double edge) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Eigen::Vector3d(tile.x * edge, tile.y * edge, -kInfinity),
          Eigen::Vector3d((tile.x + 1) * edge, (tile.y + 1) * edge, kInfinity)};
}

/** Number of the tile along an axis. */
int tileOf(int key, int levels) { return (key >> levels) - (kKeyOfOrigin >> levels); }

}  // namespace

std::string Tile::fileName() const {
  return std::to_string(x) + "_" + std::to_string(y) + ".semantic";
}

std::vector<Tile> tilesOf(const SemanticOcTree& map, int levels) {
  std::set<Tile> tiles;
  const auto depth = static_cast<unsigned>(kTreeDepth - levels);
  for (auto it = map.begin_leafs(depth); it != map.end_leafs(); ++it) {
    const auto key = it.getIndexKey();
    const int x = tileOf(key[0], levels), y = tileOf(key[1], levels);
    const int edge = 1 << (depth - it.getDepth());  // more than 1 for leaves above the tiles
    for (int i = 0; i < edge; ++i)
      for (int j = 0; j < edge; ++j) tiles.insert({x + i, y + j});
  }
  return {tiles.begin(), tiles.end()};
}

void saveTiles(const SemanticOcTree& map, int levels, const std::vector<Tile>& tiles,
               const std::filesystem::path& folder) {
  const double edge = map.getResolution() * (1 << levels);
  strict_files::OutputFolder output(folder);
  std::vector<std::string> names;
  for (const Tile& tile : tiles) {
    names.push_back(tile.fileName());
    saveTree(cropped(map, boxOf(tile, edge)), output.staged(names.back()).string());
  }
  output.commit(names);
}

}  // namespace semantic_map_edit
