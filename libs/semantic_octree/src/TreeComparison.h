#pragma once
#include <algorithm>
#include <cstring>

#include "GTree.h"
#include "NodeStore.h"

namespace semantic_octree {

/** Compares nodes of two trees, and all that is below. */
class TreeComparison {
 public:
  TreeComparison(const NodeStore& a, const NodeStore& b, bool withState)
      : m_a(a), m_b(b), m_withState(withState) {}

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
  /** What a node is, not what was told of it. */
  bool sameState(const Slot& a, const Slot& b) const {
    if (!m_withState) return true;
    const InnerState &x = *m_a.state<InnerState>(a), &y = *m_b.state<InnerState>(b);
    return x.density == y.density && x.gValue == y.gValue && x.isExpanded == y.isExpanded &&
           x.expandedOctants == y.expandedOctants &&
           std::memcmp(x.row(), y.row(), m_a.stateBytes() - sizeof(InnerState)) == 0;
  }

  const NodeStore &m_a, &m_b;
  bool m_withState;
};

}  // namespace semantic_octree
