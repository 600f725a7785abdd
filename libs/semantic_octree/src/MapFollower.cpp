#include <semantic_octree/MapFollower.h>
#include <semantic_octree/store/MapAccess.h>

namespace semantic_octree {

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
