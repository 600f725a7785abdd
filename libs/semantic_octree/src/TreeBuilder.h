#pragma once
#include "Cell.h"
#include "LeafContent.h"

namespace semantic_octree {

/** Fills an empty map from the top.
 *
 * A cursor stands for a cube of the new map: `bool known()`, whether anything may be known in it,
 * asked first; `bool isLeaf()`, whether all of it is alike; `LeafContent content()` if so;
 * `Cursor child(int i)`, which must also work for cubes that are leaves. */
class TreeBuilder {
 public:
  template <typename Cursor>
  static void fill(SemanticOcTree& map, const Cursor& root) {
    TreeBuilder builder(map);
    if (builder.build(map.m_store->root(), root, 0)) map.attachRoot();
  }
  /** An empty map of the same kind. */
  static SemanticOcTree emptyLike(const SemanticOcTree& map) {
    SemanticOcTree empty(map.getResolution(), map.classes(), map.filterParameters());
    empty.setPruning(map.pruning());
    return empty;
  }

 private:
  explicit TreeBuilder(SemanticOcTree& map)
      : m_arena(map.m_store->arena(0)), m_pruning(map.pruning()) {}

  /** \return whether anything is known in the cube */
  template <typename Cursor>
  bool build(Node& node, const Cursor& cursor, int depth) {
    if (!cursor.known()) return false;
    if (cursor.isLeaf() && (m_pruning || depth == kTreeDepth)) {
      cursor.content().write(m_arena, node);
      return true;
    }
    return buildChildren(node, cursor, depth);
  }

  template <typename Cursor>
  bool buildChildren(Node& node, const Cursor& cursor, int depth) {
    Octant& octant = m_arena.createOctant(node);
    bool known = false;
    for (int i = 0; i < 8; ++i)
      if (build(m_arena.createChild(octant, i), cursor.child(i), depth + 1))
        known = true;
      else
        m_arena.removeChild(octant, i);
    if (!known)
      m_arena.removeOctant(node);
    else if (!(m_pruning && m_arena.prune(node)))
      NodeStore::updateOccupancy(node);
    return known;
  }

  NodeArena& m_arena;
  bool m_pruning;
};

}  // namespace semantic_octree
