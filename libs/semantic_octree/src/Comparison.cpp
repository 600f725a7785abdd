#include <semantic_octree/SemanticOcTree.h>

#include <cstring>

#include "AbstractionUpkeep.h"

namespace semantic_octree {
namespace {

/** Compares two trees node by node. */
class Comparison {
 public:
  Comparison(const NodeStore& a, const NodeStore& b, const AbstractionUpkeep* upkeep)
      : m_a(a), m_b(b), m_upkeep(upkeep) {}

  bool same(const Node& a, const Node& b) const {
    if (a.isLeaf() != b.isLeaf() || a.getValue() != b.getValue()) return false;
    if (!a.isLeaf()) return sameState(a, b) && sameChildren(a, b);
    return a.hasClassRecord() == b.hasClassRecord() &&
           (!a.hasClassRecord() || m_a.record(a) == m_b.record(b));
  }

 private:
  bool sameChildren(const Node& a, const Node& b) const {
    for (int i = 0; i < 8; ++i) {
      const Node *childA = NodeStore::child(a, i), *childB = NodeStore::child(b, i);
      if (!childA != !childB || (childA && !same(*childA, *childB))) return false;
    }
    return true;
  }
  /** What a node is, not what was reported of it. */
  bool sameState(const Node& a, const Node& b) const {
    if (!m_upkeep) return true;
    const InnerState &x = *m_a.state<InnerState>(a), &y = *m_b.state<InnerState>(b);
    return x.density == y.density && x.gain == y.gain && x.splitEntropy == y.splitEntropy &&
           x.isExpanded == y.isExpanded &&
           std::memcmp(x.row(), y.row(), m_upkeep->stateBytes() - sizeof(InnerState)) == 0;
  }

  const NodeStore &m_a, &m_b;
  const AbstractionUpkeep* m_upkeep;
};

}  // namespace

bool SemanticOcTree::operator==(const SemanticOcTree& o) const {
  if (resolution != o.resolution || m_classes != o.m_classes || !(m_parameters == o.m_parameters) ||
      m_pruning != o.m_pruning || empty() != o.empty() || size() != o.size())
    return false;
  const bool sameRows =
      m_upkeep && o.m_upkeep && m_upkeep->stateBytes() == o.m_upkeep->stateBytes();
  return empty() || Comparison(*m_store, *o.m_store, sameRows ? m_upkeep.get() : nullptr)
                        .same(*root(), *o.root());
}

}  // namespace semantic_octree
