#pragma once
#include <semantic_octree/store/NodeObserver.h>

#include <algorithm>

namespace semantic_octree {

/** Compares nodes of two trees, and all that is below. */
class TreeComparison {
 public:
  /** \param observer of both, whose bookkeeping counts; null: it does not */
  TreeComparison(const NodeStore& a, const NodeStore& b, const NodeObserver* observer)
      : m_a(a), m_b(b), m_observer(observer) {}

  bool same(const Slot& a, const Slot& b) const {
    m_a.bring(a);
    m_b.bring(b);
    if (a.kind != b.kind || a.value != b.value) return false;
    switch (a.kind) {
      case Slot::Kind::None:
      case Slot::Kind::Leaf:
        return true;
      case Slot::Kind::LeafWithRecord:
        return m_a.record(a) == m_b.record(b);
      case Slot::Kind::Octant:
        return sameState(a, b) && sameChildren(m_a.octant(a), m_b.octant(b));
      case Slot::Kind::Block:
        return sameState(a, b) && sameVoxels(m_a.block(a), m_b.block(b));
      case Slot::Kind::Away:  // it was brought
        break;
    }
    return false;
  }

 private:
  bool sameChildren(const Octant& a, const Octant& b) const {
    for (int i = 0; i < 8; ++i)
      if (!same(a.slots[i], b.slots[i])) return false;
    return true;
  }
  bool sameVoxels(const Block& a, const Block& b) const {
    return a.known == b.known && a.leafOctants == b.leafOctants && a.recorded == b.recorded &&
           std::equal(a.values, a.values + 64, b.values) &&
           (!a.recorded ||
            std::equal(m_a.recordsOf(a), m_a.recordsOf(a) + a.numRecords(), m_b.recordsOf(b)));
  }
  bool sameState(const Slot& a, const Slot& b) const {
    return !m_observer || m_observer->sameState(m_a, a, m_b, b);
  }

  const NodeStore &m_a, &m_b;
  const NodeObserver* m_observer;
};

}  // namespace semantic_octree
