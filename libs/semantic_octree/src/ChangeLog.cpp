#include <semantic_octree/store/ChangeLog.h>

#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/MapAccess.h>

#include <algorithm>

namespace semantic_octree {
namespace {

constexpr int kDepthAt = 48;  // its bits, above those of the three indices

std::uint64_t pack(const Cell& cube) {
  const auto bits = [](int number, int at) { return static_cast<std::uint64_t>(number) << at; };
  return bits(cube.depth, kDepthAt) | bits(cube.index.z(), 32) | bits(cube.index.y(), 16) |
         bits(cube.index.x(), 0);
}

int index(std::uint64_t packed, int at) { return static_cast<int>(packed >> at & 0xffff); }

octomap::OcTreeKey lowestKey(std::uint64_t packed) {
  const auto key = [packed](int at) {
    return static_cast<octomap::key_type>(index(packed, at) * edgeAtDepth(kTileDepth));
  };
  return octomap::OcTreeKey(key(0), key(16), key(32));
}

}  // namespace

void TileLog::add(const Cell& cube) { push(pack(cube)); }

void TileList::add(std::uint64_t cube) {
  addAll({VoxelIndex(index(cube, 0), index(cube, 16), index(cube, 32)), index(cube, kDepthAt)});
}

void TileList::add(const SemanticOcTreeNode& node, const Cell& cell) {
  if (node.isLeaf() || cell.depth == kTileDepth) return addAll(cell);
  for (int i = 0; i < 8; ++i)
    if (const SemanticOcTreeNode child = node.child(i)) add(child, cell.child(i));
}

void TileList::addAll(const Cell& cube) {
  if (cube.depth == kTileDepth) return m_tiles.push_back(pack(cube));
  for (int i = 0; i < 8; ++i) addAll(cube.child(i));
}

std::vector<octomap::OcTreeKey> TileList::keys() {
  std::sort(m_tiles.begin(), m_tiles.end());
  m_tiles.erase(std::unique(m_tiles.begin(), m_tiles.end()), m_tiles.end());
  std::vector<octomap::OcTreeKey> keys(m_tiles.size());
  std::transform(m_tiles.begin(), m_tiles.end(), keys.begin(), lowestKey);
  return keys;
}

struct MapFollower::Content {
  FollowedMap map;
  std::unique_ptr<TileLog::Place> place = nullptr;

  TileLog::Place& placeNow() { return placeIn(place, MapAccess::tileLog(map.get())); }
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
  TileLog::Place& place = m->placeNow();
  TileList list;
  if (!place.isLost())
    for (const std::uint64_t cube : place) list.add(cube);
  else if (!map.empty())
    list.add(map.root(), Cell());
  TileChange change{place.isLost(), list.keys()};
  place.moveToEnd();
  return change;
}

void MapFollower::skipTiles() { m->placeNow().moveToEnd(); }

}  // namespace semantic_octree
