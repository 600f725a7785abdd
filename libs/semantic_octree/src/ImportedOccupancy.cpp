#include <semantic_octree/MapOperations.h>

#include <stdexcept>
#include <string>

#include "TreeBuilder.h"

namespace semantic_octree {
namespace {

class OccupancyCursor {
 public:
  OccupancyCursor(const octomap::OcTree& map, const ClassFilter<float>& filter,
                  const octomap::OcTreeNode* node)
      : m_map(map), m_filter(filter), m_node(node) {}

  bool known() const { return m_node; }
  bool isLeaf() const { return !m_map.nodeHasChildren(m_node); }
  LeafContent content() const { return {m_filter.limitedOccupancy(m_node->getLogOdds()), {}}; }
  OccupancyCursor child(int i) const {
    const octomap::OcTreeNode* node = m_node;
    if (!isLeaf())
      node = m_map.nodeChildExists(m_node, i) ? m_map.getNodeChild(m_node, i) : nullptr;
    return {m_map, m_filter, node};
  }

 private:
  const octomap::OcTree& m_map;
  const ClassFilter<float>& m_filter;
  const octomap::OcTreeNode* m_node;
};

}  // namespace

SemanticOcTree fromOccupancy(const octomap::OcTree& map, const ClassTable& classes,
                             const FilterParameters& filter) {
  if (map.getTreeDepth() != kTreeDepth)
    throw std::invalid_argument("importing occupancy: a map of " +
                                std::to_string(map.getTreeDepth()) + " levels, expected 16");
  SemanticOcTree result(map.getResolution(), classes, filter);
  const ClassFilter<float> limits(classes.size(), filter);
  TreeBuilder::fill(result, OccupancyCursor(map, limits, map.getRoot()));
  return result;
}

}  // namespace semantic_octree
