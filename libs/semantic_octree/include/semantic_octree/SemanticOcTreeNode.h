#pragma once
#include <semantic_octree/Keys.h>

#include <cstddef>
#include <cstdint>

namespace semantic_octree {

class NodeStore;
struct Slot;

/** A node of the semantic octree, or none: a small value that is used like OctoMap's pointer to a
 * node (`if (node)`, `node->isLeaf()`, `*node`). Valid until the map changes.
 *
 * The last two levels of the tree are stored as blocks of 4 x 4 x 4 voxels: what is stored of a
 * node in them follows from the block. */
class SemanticOcTreeNode {
 public:
  /** No node: space that is unknown. */
  SemanticOcTreeNode() = default;

  explicit operator bool() const { return m_slot != nullptr; }
  const SemanticOcTreeNode& operator*() const { return *this; }
  const SemanticOcTreeNode* operator->() const { return this; }
  /** Whether both are one node of one map. */
  bool operator==(const SemanticOcTreeNode& o) const {
    return m_slot == o.m_slot && m_part == o.m_part;
  }
  bool operator!=(const SemanticOcTreeNode& o) const { return !(*this == o); }
  bool operator==(std::nullptr_t) const { return !*this; }
  bool operator!=(std::nullptr_t) const { return static_cast<bool>(*this); }

  bool isLeaf() const;
  /** The i-th child of an inner node in OctoMap's order (x is bit 0, y bit 1, z bit 2); none: space
   * that is unknown. */
  SemanticOcTreeNode child(int i) const;
  /** ln(p(occupied) / p(free)); an inner node's is that of its most occupied leaf. */
  float getLogOdds() const;
  /** p(occupied). */
  double getOccupancy() const;
  /** A leaf with a class record (see SemanticOcTree::belief). */
  bool hasClassRecord() const;

 private:
  friend class NodeStore;
  /** Parts of a block: all of it, its octants, its voxels. */
  static constexpr std::uint8_t kWhole = 0, kFirstOctant = 1, kFirstVoxel = 9;

  SemanticOcTreeNode(const NodeStore& store, const Slot& slot, int part = kWhole)
      : m_store(&store), m_slot(&slot), m_part(static_cast<std::uint8_t>(part)) {}
  bool isOctant() const { return m_part >= kFirstOctant && m_part < kFirstVoxel; }

  const NodeStore* m_store = nullptr;
  const Slot* m_slot = nullptr;
  std::uint8_t m_part = kWhole;
};

}  // namespace semantic_octree
