#include <semantic_octree/store/NodeObserver.h>

namespace semantic_octree {

void recomputeAll(NodeObserver::Worker& worker, NodeStore& store, Slot& slot, const Cell& cell) {
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
