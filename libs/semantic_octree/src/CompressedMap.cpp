#include <semantic_octree/Abstraction.h>

#include "LeafContent.h"
#include "OptimalTree.h"

namespace semantic_octree {

SemanticOcTree Abstraction::compressedMap() const {
  SemanticOcTree compressed(m_map.getResolution(), m_map.classes(), m_map.filterParameters());
  if (m_map.empty()) return compressed;
  NodeStore& store = *compressed.m_store;
  NodeArena& arena = store.arena(0);
  const OptimalTree optimal(*m_map.m_store, m_upkeep);
  const auto copy = [&](const auto& self, const Node& from, Node& to) -> void {
    if (!optimal.isExpanded(from)) return contentOf(m_map, from).write(arena, to);
    to.setValue(from.getValue());
    Octant& octant = arena.createOctant(to);
    for (int i = 0; i < 8; ++i)
      if (const Node* child = NodeStore::child(from, i))
        self(self, *child, arena.createChild(octant, i));
  };
  copy(copy, *m_map.root(), store.root());
  compressed.attachRoot();
  return compressed;
}

}  // namespace semantic_octree
