#pragma once
#include <semantic_octree/store/ChangeLog.h>
#include <semantic_octree/store/NodeObserver.h>

namespace semantic_octree {

class FusionRule;

/** A tree that is changed, and who has to know. */
struct MergeTarget {
  NodeStore& store;
  const ClassFilter& filter;
  /** What observations make of voxels; null: the filter. */
  const FusionRule* rule;
  /** Keeps inner nodes' bookkeeping up to date; null: there is none. */
  NodeObserver* observer;
  /** Is told where something changed; null: nobody wants to know. */
  ChangeLog* touched;
  /** Children that agree are merged; off: every known leaf is a voxel. */
  bool pruning;
};

/** One thread's way to change a tree: what all have to do who change its nodes. */
class NodeEditor {
 public:
  /** \param thread number of the thread that it works in */
  NodeEditor(const MergeTarget& target, int thread)
      : store(target.store),
        arena(target.store.arena(thread)),
        pruning(target.pruning),
        m_observer(target.observer ? &target.observer->worker(thread) : nullptr),
        m_touched(target.touched) {}

  NodeStore& store;
  NodeArena& arena;
  const bool pruning;

  /** Prunes or recomputes an inner node, whose children are up to date; one without children is
   * removed. \return changed */
  bool finish(Slot& inner, const Cube& cell, bool changed, bool reshaped) {
    if (pruning && arena.prune(inner)) return changed;
    if (!changed) return false;
    inner.value = store.highestValueBelow(inner);
    if (inner.value == kUnknown)
      arena.remove(inner);
    else
      recompute(inner, cell, reshaped);
    return true;
  }
  void recompute(Slot& inner, const Cube& cell, bool reshaped) {
    if (m_observer) m_observer->recompute(store, inner, cell, reshaped);
  }

  /** Takes down that a tile, or a larger cube, changed. \return changed */
  bool note(const Cube& cube, bool changed) {
    if (changed && m_touched) m_changed.push_back(cube);
    return changed;
  }
  /** Tells what was taken down; not from several threads at once. */
  void tellNoted() {
    for (const Cube& cube : m_changed) m_touched->push(packed(cube));
    m_changed.clear();
  }

 private:
  NodeObserver::Worker* m_observer;
  ChangeLog* m_touched;
  std::vector<Cube> m_changed;
};

}  // namespace semantic_octree
