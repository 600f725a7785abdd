#include <semantic_octree/MapOperations.h>

#include <stdexcept>
#include <string>

#include "TreeBuilder.h"

namespace semantic_octree {
namespace {

/** A cube of the coarse map and the node of the fine map for it. The fine map fills the middle of
 * the coarse one: down to depth `levels` the cubes that touch the middle hold one octant of it
 * each, and `node` is still the fine map's root. */
class CoarseCursor {
 public:
  CoarseCursor(const SemanticOcTree& map, int levels)
      : CoarseCursor(map, levels, map.root(), 0, -1) {}

  bool known() const { return m_node; }
  bool isLeaf() const { return m_depth == kTreeDepth || (m_depth > m_levels && m_node->isLeaf()); }
  LeafContent content() const { return contentOf(m_map, *m_node); }

  CoarseCursor child(int i) const {
    if (m_depth < m_levels) {
      const bool towardsMiddle = m_depth == 0 || i == 7 - m_octant;
      const int octant = m_depth == 0 ? i : m_octant;
      return {m_map, m_levels, towardsMiddle ? m_node : nullptr, m_depth + 1, octant};
    }
    if (m_depth == m_levels && m_depth > 0)
      return {m_map, m_levels, i == 7 - m_octant ? childNode(m_octant) : nullptr, m_depth + 1, -1};
    return {m_map, m_levels, childNode(i), m_depth + 1, -1};
  }

 private:
  CoarseCursor(const SemanticOcTree& map, int levels, const Node* node, int depth, int octant)
      : m_map(map), m_levels(levels), m_node(node), m_depth(depth), m_octant(octant) {}

  const Node* childNode(int i) const {
    return m_node->isLeaf() ? m_node : NodeStore::child(*m_node, i);
  }

  const SemanticOcTree& m_map;
  int m_levels;
  const Node* m_node;
  int m_depth, m_octant;
};

}  // namespace

SemanticOcTree coarsened(const SemanticOcTree& map, int levels) {
  if (levels < 0 || levels > 8)
    throw std::invalid_argument("coarsening: levels = " + std::to_string(levels) +
                                ", expected 0 to 8");
  SemanticOcTree coarse(map.getResolution() * (1 << levels), map.classes(), map.filterParameters());
  coarse.setPruning(map.pruning());
  TreeBuilder::fill(coarse, CoarseCursor(map, levels));
  return coarse;
}

}  // namespace semantic_octree
