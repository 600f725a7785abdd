#pragma once
#include <octomap/octomap_types.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <iterator>
#include <vector>

namespace semantic_octree {

class SemanticOcTree;

/** Walks over a map's nodes depth first, children in OctoMap's order, as OctoMap's iterators do.
 * Used through SemanticOcTree::begin_leafs() and the like. Valid until the map changes. */
class TreeIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = SemanticOcTreeNode;
  using difference_type = std::ptrdiff_t;
  using pointer = const SemanticOcTreeNode*;
  using reference = const SemanticOcTreeNode&;

  /** What it stops at. */
  struct Selection {
    /** Nodes at this depth are the last, whether they are leaves or not. */
    int maxDepth = kTreeDepth;
    bool innerNodes = false;  ///< before their children
    /** Only nodes with voxels in a box (keys, both ends included). */
    octomap::OcTreeKey low{0, 0, 0}, high{kNumKeys - 1, kNumKeys - 1, kNumKeys - 1};
  };

  /** The end. */
  TreeIterator() = default;
  TreeIterator(const SemanticOcTree& tree, const Selection& selection);

  reference operator*() const { return m_stack.back().node; }
  pointer operator->() const { return &m_stack.back().node; }
  TreeIterator& operator++();
  bool operator==(const TreeIterator& o) const {
    if (m_stack.empty() || o.m_stack.empty()) return m_stack.empty() == o.m_stack.empty();
    return m_stack.size() == o.m_stack.size() && m_stack.back().node == o.m_stack.back().node;
  }
  bool operator!=(const TreeIterator& o) const { return !(*this == o); }

  unsigned getDepth() const { return static_cast<unsigned>(m_stack.back().depth); }
  bool isLeaf() const;
  /** Key of the voxel just above the cube's center; of a voxel, its own. */
  octomap::OcTreeKey getKey() const { return keyAbove(edgeAtDepth(m_stack.back().depth) / 2); }
  /** Key of the cube's lowest voxel. */
  octomap::OcTreeKey getIndexKey() const { return keyAbove(0); }
  /** Edge of the cube, meters. */
  double getSize() const { return m_voxelSize * edgeAtDepth(m_stack.back().depth); }
  /** Center of the cube, meters, map frame. */
  octomap::point3d getCoordinate() const;
  double getX() const { return center(0); }
  double getY() const { return center(1); }
  double getZ() const { return center(2); }

 private:
  struct Entry {
    SemanticOcTreeNode node;
    int lowest[3];
    int depth;
  };
  double center(int axis) const {
    const Entry& at = m_stack.back();
    return centerOf(at.lowest[axis], m_voxelSize, at.depth);
  }
  octomap::OcTreeKey keyAbove(int offset) const {
    const int* k = m_stack.back().lowest;
    return octomapKey(k[0] + offset, k[1] + offset, k[2] + offset);
  }
  bool isWanted(const Entry& entry) const;
  bool isLast(const Entry& entry) const {
    return entry.depth == m_selection.maxDepth || entry.node.isLeaf();
  }
  /** Replaces the node on top by its children. */
  void descend();
  void toNext();

  std::vector<Entry> m_stack;
  Selection m_selection;
  bool m_hasBox = false;
  double m_voxelSize = 0;
};

}  // namespace semantic_octree
