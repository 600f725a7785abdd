#include <semantic_octree/store/MapAccess.h>

#include <semantic_octree/store/NodeObserver.h>
#include <semantic_octree/store/Scan.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "Decay.h"
#include "ScanMerger.h"

namespace semantic_octree {
namespace {

/** A store's nodes with room for this bookkeeping; those of tiles are away then. */
std::unique_ptr<NodeStore> storeFor(const NodeStore& store, std::size_t stateBytes) {
  if (!store.tiles()) return std::make_unique<NodeStore>(store, stateBytes);
  store.tiles()->sendAway();
  return store.copy(stateBytes, NodeStore::Tiles::StayAway);
}

}  // namespace

void MapAccess::setRule(SemanticOcTree& map, std::shared_ptr<const FusionRule> rule) {
  if (!map.empty()) throw std::logic_error("a rule of fusion for a map that is not empty");
  map.m_rule = std::move(rule);
}

void MapAccess::setObserver(SemanticOcTree& map, std::unique_ptr<NodeObserver> observer) {
  const bool isInTiles = store(map).tiles();
  auto nodes = storeFor(store(map), observer ? observer->stateBytes() : 0);
  if (observer && !isInTiles) recomputeAll(observer->worker(0), *nodes, nodes->root(), Cube());
  std::swap(map.m_observer, observer);
  map.m_store = std::move(nodes);  // first, so that tiles come in where the old nodes were
  if (isInTiles) recomputeTileByTile(map);
}

void MapAccess::recomputeTileByTile(SemanticOcTree& map) {
  if (!map.m_observer) return;
  try {
    recomputeAll(map.m_observer->worker(0), store(map), store(map).root(), Cube());
  } catch (...) {  // tiles came and went meanwhile: what was cannot be had back
    map.m_observer = nullptr;
    throw;
  }
}

std::weak_ptr<SemanticOcTree*> MapAccess::self(SemanticOcTree& map) {
  if (!map.m_self) map.m_self = std::make_shared<SemanticOcTree*>(&map);
  return map.m_self;
}

void MapAccess::tellAll(SemanticOcTree& map) {
  map.m_tileLog.reset();
  if (map.m_observer) map.m_observer->tellAll();
}

SemanticOcTree& FollowedMap::get() const {
  const auto map = m_map.lock();
  if (!map) throw std::logic_error("the map that is followed is gone");
  MapAccess::store(**map);  // it is not broken
  return **map;
}

void MapAccess::checkMayChange(const SemanticOcTree& map) {
  if (map.m_store && map.isReadOnly())
    throw std::logic_error("a map cannot change whose folder of tiles was opened to be read");
}

SemanticOcTree MapAccess::emptyWith(const SemanticOcTree& map, double resolution) {
  SemanticOcTree empty(resolution, map.classes(), map.filterParameters());
  empty.setPruning(map.pruning());
  empty.m_clock = map.m_clock;
  empty.m_rule = map.m_rule;
  return empty;
}

void MapAccess::merge(SemanticOcTree& map, const Scan& scan, int threads) {
  if (!scan.hasVoxels()) return;
  checkMayChange(map);
  if (store(map).tiles()) store(map).tiles()->prepare(scan);
  change(map, [&](const MergeTarget& target) { mergeScan(target, scan, threads); });
}

std::int64_t MapAccess::timeIn(const SemanticOcTree& map, double seconds) {
  if (!(seconds >= 0 && seconds <= 1e9))
    throw std::invalid_argument("a map ages by 0 to 1000000000 s, not by " +
                                std::to_string(seconds) + " s");
  if (!map.classes().hasHalfLives()) return map.m_clock;
  const std::int64_t time = map.m_clock + std::llround(seconds * 1e9);
  if (time > kOldestMap) throw std::out_of_range("a map ages by no more than 200 years in all");
  return time;
}

void MapAccess::ageUntil(SemanticOcTree& map, std::int64_t time) {
  if (time == map.m_clock) return;
  checkMayChange(map);
  std::vector<int> steps;
  for (int id = 0; id <= map.numClasses(); ++id)
    steps.push_back(
        decaySteps(map.classes().halfLife(static_cast<ClassId>(id)), map.m_clock, time));
  map.m_clock = time;  // first, for tiles' files
  if (!map.empty() && std::any_of(steps.begin(), steps.end(), [](int n) { return n > 0; }))
    change(map, [&](const MergeTarget& target) { decay(target, steps); });
}

ReadLock::ReadLock(const SemanticOcTree& map) : m_store(MapAccess::store(map)) {
  m_store.beginReading();
}
ReadLock::~ReadLock() { m_store.endReading(); }

void recomputeAll(NodeObserver::Worker& worker, NodeStore& store, Slot& slot, const Cube& cell) {
  if (!slot.isInner()) return;
  if (slot.kind == Slot::Kind::Away) return store.bring(slot);  // whoever brings it computes it
  if (slot.kind == Slot::Kind::Octant) {
    Octant& octant = store.octant(slot);
    for (const Slot& child : octant.slots) store.prefetchInner(child);
    for (int i = 0; i < 8; ++i) recomputeAll(worker, store, octant.slots[i], cell.child(i));
  }
  worker.recompute(store, slot, cell, false);
}

}  // namespace semantic_octree
