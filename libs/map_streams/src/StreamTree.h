#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/Cubes.h>
#include <semantic_octree/store/LeafContent.h>

#include <array>
#include <memory>
#include <optional>
#include <set>

#include "Bytes.h"

namespace semantic_octree {

/** A cube by its path from the root, three bits a level (the number of a child); the last level's
 * are the lowest. */
struct CellPath {
  std::uint64_t path = 0;
  int depth = 0;

  static CellPath of(const Cube& cube);
  CellPath child(int i) const { return {path << 3 | static_cast<unsigned>(i), depth + 1}; }
  CellPath above(int atDepth) const { return {path >> 3 * (depth - atDepth), atDepth}; }
  /** Which child of its parent the cube's ancestor at a depth from 1 on is. */
  int childAt(int atDepth) const { return static_cast<int>(path >> 3 * (depth - atDepth) & 7); }
  /** The first voxel's path, depth first. */
  std::uint64_t first() const { return path << 3 * (kTreeDepth - depth); }
  /** Voxels in it. */
  std::uint64_t size() const { return std::uint64_t{1} << 3 * (kTreeDepth - depth); }
  bool operator==(const CellPath& o) const { return path == o.path && depth == o.depth; }
  /** Depth first, parents before their children. */
  bool operator<(const CellPath& o) const {
    return first() != o.first() ? first() < o.first() : depth < o.depth;
  }
};

/** A leaf as it travels, or no node. */
using StreamLeaf = std::optional<LeafContent>;
/** As bytes: 0 for no node, 1 for a leaf without a class record, 2 for one with it; what it holds.
 */
void put(ByteWriter& to, const StreamLeaf& leaf);
void get(ByteReader& from, StreamLeaf& leaf);

/** What is said of a cube at once. */
struct TreePart {
  CellPath cell;
  /** The cube is an inner node, and these of its children become leaves, or unknown; otherwise it
   * becomes a leaf itself, the first of `leaves`. */
  bool isOctet = false;
  std::uint8_t mask = 1;  ///< children of which it is said
  std::array<StreamLeaf, 8> leaves;
};

/** Calls visit(leaf) for those that a part's mask names. */
template <class Part, class Visit>
void forEachLeaf(Part& part, const Visit& visit) {
  for (int i = 0; i < 8; ++i)
    if (part.mask >> i & 1) visit(part.leaves[i]);
}

/** A tree of which more and more becomes known: what a receiver has, and what a sender knows that
 * it will have. It is kept as a map is. */
class StreamTree {
 public:
  StreamTree() = default;
  StreamTree(const StreamTree& o)
      : m_store(o.m_store->copy(0)), m_revision(o.m_revision), m_newInner(o.m_newInner) {}
  StreamTree(StreamTree&&) = default;
  StreamTree& operator=(StreamTree&&) = default;

  /** None: the tree is empty. */
  Node root() const { return m_store->rootNode(); }
  std::size_t numLeaves() const { return m_store->numNodes() - m_store->numInnerNodes(); }
  /** Whether the cube is a leaf or an inner node. */
  bool has(const CellPath& cell);

  /** An octet needs its cube to be there, as a leaf or an inner node. A leaf makes its place: a
   * larger leaf becomes eight that say the same. It does not replace an inner node of the same
   * revision, for what made it one is younger. If it fails, what it has done is done again to no
   * effect. \return whether the part found its place */
  bool apply(const TreePart& part, std::uint32_t revision);
  /** The tree as a map. \param empty a map of the same kind */
  SemanticOcTree map(const SemanticOcTree& empty) const;

 private:
  NodeArena& arena() { return m_store->arena(0); }
  /** The cube's slot, or that of the block that it is in; null: there is none. */
  Slot* find(const CellPath& cell);
  /** The slot of a cell, which is made if need be. */
  Slot& makePlace(const CellPath& cell);
  void replace(Slot& slot, Slot by);
  void setLeaf(Slot& slot, const CellPath& cell, const StreamLeaf& leaf);
  void setLeafInBlock(BlockContent& block, const CellPath& cell, const StreamLeaf& leaf);
  void setChildren(Slot& inner, const TreePart& octet);
  /** \param slot of the block \param part in there */
  void changeBlock(Slot& slot, const TreePart& part);
  void noteInner(const CellPath& cell) {
    if (m_revision > 1) m_newInner.insert(cell);
  }
  bool isNewInner(const CellPath& cell) const {
    return m_revision <= 1 || m_newInner.count(cell) > 0;
  }

  std::unique_ptr<NodeStore> m_store = std::make_unique<NodeStore>(0);
  std::uint32_t m_revision = 0;
  std::set<CellPath> m_newInner;  ///< of this revision; of the first, all are
};

}  // namespace semantic_octree
