#include <semantic_octree/Abstraction.h>
#include <semantic_octree/MapFollower.h>

#include <stdexcept>

#include "LeafLog.h"
#include "NodeStore.h"
#include "TileLog.h"

namespace semantic_octree {
namespace {

/** The reader's place, lost if it was in another log. */
template <typename Log>
typename Log::Place& placeIn(std::unique_ptr<typename Log::Place>& place,
                             const std::shared_ptr<Log>& log) {
  if (!place || !place->isIn(*log)) place = std::make_unique<typename Log::Place>(log);
  return *place;
}

}  // namespace

class MapFollower::Places {
 public:
  explicit Places(std::weak_ptr<SemanticOcTree*> map) : m_map(std::move(map)) {}

  SemanticOcTree& map() const {
    const auto map = m_map.lock();
    if (!map) throw std::logic_error("the map that is followed is gone");
    (*map)->store();  // it is not broken
    return **map;
  }
  TileLog::Place& tiles() { return placeIn(m_tiles, readLog(map().m_tileLog)); }
  LeafLog::Place& leaves(const std::shared_ptr<LeafLog>& log) { return placeIn(m_leaves, log); }

 private:
  std::weak_ptr<SemanticOcTree*> m_map;
  std::unique_ptr<TileLog::Place> m_tiles;
  std::unique_ptr<LeafLog::Place> m_leaves;
};

MapFollower::MapFollower(std::unique_ptr<Places> places) : m_places(std::move(places)) {}
MapFollower::~MapFollower() = default;
MapFollower::MapFollower(MapFollower&&) noexcept = default;
MapFollower& MapFollower::operator=(MapFollower&&) noexcept = default;

MapFollower SemanticOcTree::follow() {
  if (!m_self) m_self = std::make_shared<SemanticOcTree*>(this);
  return MapFollower(std::make_unique<MapFollower::Places>(m_self));
}

TileChange MapFollower::tiles() {
  const SemanticOcTree& map = m_places->map();
  TileLog::Place& place = m_places->tiles();
  TileList list;
  if (!place.isLost())
    for (const std::uint64_t cube : place) list.add(cube);
  else if (!map.empty())
    list.add(map.root(), Cell());
  TileChange change{place.isLost(), list.keys()};
  place.moveToEnd();
  return change;
}

void MapFollower::skipTiles() { m_places->tiles().moveToEnd(); }

TreeChange MapFollower::leaves() {
  const auto log = Abstraction(m_places->map()).leafLog();
  LeafLog::Place& place = m_places->leaves(log);
  TreeChange change = place.isLost() ? log->everything() : LeafLog::since(place);
  place.moveToEnd();
  return change;
}

std::size_t MapFollower::skipLeaves() {
  const auto log = Abstraction(m_places->map()).leafLog();
  m_places->leaves(log).moveToEnd();
  return log->numLeaves();
}

}  // namespace semantic_octree
