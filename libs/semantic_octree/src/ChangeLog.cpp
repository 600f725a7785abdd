#include <semantic_octree/store/ChangeLog.h>

#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/MapAccess.h>

#include <algorithm>

namespace semantic_octree {
namespace {

/** Packed cubes. */
using Tiles = std::vector<std::uint64_t>;

void addTilesIn(const Cube& cube, Tiles& tiles) {
  if (cube.depth == kTileDepth) return tiles.push_back(packed(cube));
  for (int i = 0; i < 8; ++i) addTilesIn(cube.child(i), tiles);
}

/** The tiles that a node's leaves are in. */
void addTilesOf(const Node& node, const Cube& cube, Tiles& tiles) {
  if (node.isLeaf() || cube.depth == kTileDepth) return addTilesIn(cube, tiles);
  for (int i = 0; i < 8; ++i)
    if (const Node child = node.child(i)) addTilesOf(child, cube.child(i), tiles);
}

/** Each once, sorted. */
std::vector<octomap::OcTreeKey> keysOf(Tiles tiles) {
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  std::vector<octomap::OcTreeKey> keys;
  keys.reserve(tiles.size());
  for (const std::uint64_t tile : tiles) {
    const VoxelIndex lowest = unpacked(tile).lowest;
    keys.push_back(octomapKey(lowest.x(), lowest.y(), lowest.z()));
  }
  return keys;
}

}  // namespace

struct MapFollower::Content {
  FollowedMap map;
  std::unique_ptr<ChangeLog::Place> place = nullptr;

  ChangeLog::Place& placeNow() { return placeIn(place, MapAccess::tileLog(map.get())); }
};

MapFollower::MapFollower(std::unique_ptr<Content> content) : m(std::move(content)) {}
MapFollower::~MapFollower() = default;
MapFollower::MapFollower(MapFollower&&) noexcept = default;
MapFollower& MapFollower::operator=(MapFollower&&) noexcept = default;

MapFollower SemanticOcTree::follow() {
  return MapFollower(
      std::make_unique<MapFollower::Content>(MapFollower::Content{FollowedMap(*this)}));
}

TileChange MapFollower::tiles() {
  const SemanticOcTree& map = m->map.get();
  ChangeLog::Place& place = m->placeNow();
  Tiles tiles;
  if (!place.isLost())
    for (const std::uint64_t cube : place) addTilesIn(unpacked(cube), tiles);
  else if (!map.empty())
    addTilesOf(map.root(), Cube(), tiles);
  TileChange change{place.isLost(), keysOf(std::move(tiles))};
  place.moveToEnd();
  return change;
}

void MapFollower::skipTiles() { m->placeNow().moveToEnd(); }

}  // namespace semantic_octree
