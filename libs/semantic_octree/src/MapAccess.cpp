#include <semantic_octree/store/MapAccess.h>

#include <algorithm>
#include <stdexcept>

namespace semantic_octree {
void MapAccess::setRule(SemanticOcTree& map, std::shared_ptr<const FusionRule> rule) {
  if (!map.empty()) throw std::logic_error("a rule of fusion for a map that is not empty");
  map.m_rule = std::move(rule);
}

void MapAccess::setObserver(SemanticOcTree& map, std::unique_ptr<NodeObserver> observer) {
  TileSource* const tiles = store(map).tiles();
  if (tiles) tiles->sendAway();
  auto nodes = store(map).copy(observer ? observer->stateBytes() : 0, NodeStore::Tiles::StayAway);
  if (observer && !tiles) recomputeAll(observer->worker(0), *nodes, nodes->root(), Cube());
  std::swap(map.m_observer, observer);
  map.m_store = std::move(nodes);  // first, so that tiles come in where the old nodes were
  if (tiles) recomputeTileByTile(map);
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

ReadLock::ReadLock(const SemanticOcTree& map) : m_store(MapAccess::store(map)) {
  m_store.beginReading();
}
ReadLock::~ReadLock() { m_store.endReading(); }

namespace {

bool areSame(const NodeStore& a, const Block& x, const NodeStore& b, const Block& y) {
  return x.known == y.known && x.leafOctants == y.leafOctants && x.recorded == y.recorded &&
         std::equal(x.values, x.values + 64, y.values) &&
         (!x.recorded ||
          std::equal(a.recordsOf(x), a.recordsOf(x) + x.numRecords(), b.recordsOf(y)));
}

}  // namespace

bool areSame(const NodeStore& a, const Slot& inA, const NodeStore& b, const Slot& inB,
             const NodeObserver* observer) {
  a.bring(inA);
  b.bring(inB);
  if (inA.kind != inB.kind || inA.value != inB.value) return false;
  if (inA.kind == Slot::Kind::LeafWithRecord) return a.record(inA) == b.record(inB);
  if (!inA.isInner()) return true;
  if (observer && !observer->sameState(a, inA, b, inB)) return false;
  if (inA.kind == Slot::Kind::Block) return areSame(a, a.block(inA), b, b.block(inB));
  for (int i = 0; i < 8; ++i)
    if (!areSame(a, a.octant(inA).slots[i], b, b.octant(inB).slots[i], observer)) return false;
  return true;
}

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
