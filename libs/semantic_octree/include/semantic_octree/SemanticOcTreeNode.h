#pragma once
#include <octomap/OcTreeNode.h>

#include <cstdint>

namespace semantic_octree {

struct Octant;

/** Node of the semantic octree: OctoMap's occupancy node (log-odds; maximum of the children for an
 * inner node) plus one index: of the class record for a leaf that was hit with a label, of the
 * abstraction's bookkeeping for an inner node. 16 bytes, as OctoMap's node after padding.
 *
 * Only the tree creates and changes nodes. */
class SemanticOcTreeNode : public octomap::OcTreeNode {
 public:
  bool isLeaf() const { return children == nullptr; }
  /** The i-th child of an inner node in OctoMap's order (x is bit 0, y bit 1, z bit 2); null: space
   * that is unknown. */
  const SemanticOcTreeNode* child(int i) const {
    return static_cast<const SemanticOcTreeNode*>(children[i]);
  }
  /** A leaf with a class record (see SemanticOcTree::belief). */
  bool hasClassRecord() const { return isLeaf() && m_index != 0; }

 private:
  friend class NodeArena;
  friend class NodeStore;

  std::uint32_t m_index = 0;
};
static_assert(sizeof(SemanticOcTreeNode) == 16, "a node must stay as small as OctoMap's");

}  // namespace semantic_octree
