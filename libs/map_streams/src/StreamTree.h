#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/store/Cell.h>
#include <semantic_octree/store/LeafContent.h>

#include <array>
#include <vector>

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
  bool operator==(const CellPath& o) const { return path == o.path && depth == o.depth; }
  /** Depth first, parents before their children. */
  bool operator<(const CellPath& o) const {
    return first() != o.first() ? first() < o.first() : depth < o.depth;
  }
};

/** A leaf as it travels, or no node. */
struct StreamLeaf {
  enum class Kind : std::uint8_t { None, Plain, WithRecord };
  ClassRecord record{};
  Units value = 0;
  Kind kind = Kind::None;

  static StreamLeaf of(const LeafContent& content);
  LeafContent content() const;
  bool operator==(const StreamLeaf& o) const {
    return kind == o.kind && value == o.value && record == o.record;
  }
  bool operator!=(const StreamLeaf& o) const { return !(*this == o); }
};

/** What is said of a cube at once. */
struct TreePart {
  CellPath cell;
  /** The cube is an inner node, and these of its children become leaves, or unknown; otherwise it
   * becomes a leaf itself, the first of `leaves`. */
  bool isOctet = false;
  std::uint8_t mask = 1;  ///< children of which it is said
  std::array<StreamLeaf, 8> leaves;
};

/** A tree of which more and more becomes known: what a receiver has, and what a sender knows that
 * it will have. */
class StreamTree {
 public:
  struct Node {
    StreamLeaf leaf;          ///< of an inner node: what it was before
    std::uint32_t octet = 0;  ///< of an inner node: its children's
    bool isInner() const { return octet != 0; }
    bool isKnown() const { return isInner() || leaf.kind != StreamLeaf::Kind::None; }
  };

  StreamTree();
  const Node& root() const { return m_root; }
  const Node& child(const Node& inner, int i) const { return m_octets[inner.octet].nodes[i]; }
  std::size_t numLeaves() const { return m_numLeaves; }

  /** An octet needs its cube to be there, as a leaf or an inner node; a leaf makes its place (a
   * larger leaf becomes eight that say the same), but does not replace an inner node of the same
   * revision: what made it one is younger. \return whether the part found its place */
  bool apply(const TreePart& part, std::uint16_t revision);
  /** The tree as a map. \param empty a map of the same kind */
  SemanticOcTree map(const SemanticOcTree& empty) const;

 private:
  struct Octet {
    std::array<Node, 8> nodes;
    std::uint16_t revision = 0;  ///< when it came to be
  };
  /** None: the cube is not a node. */
  Node* find(const CellPath& cell);
  /** From here on nothing moves, and nothing fails, until the part is in its place. */
  void reserve();
  Node& makePlace(const CellPath& cell, std::uint16_t revision);
  void setLeaf(Node& node, const StreamLeaf& leaf, std::uint16_t revision);
  std::uint32_t makeInner(Node& leaf, const StreamLeaf& children, std::uint16_t revision);
  void removeBelow(Node& node);
  void count(const StreamLeaf& leaf, int times) {
    m_numLeaves += leaf.kind == StreamLeaf::Kind::None ? 0 : static_cast<std::size_t>(times);
  }

  Node m_root;
  std::vector<Octet> m_octets;
  std::vector<std::uint32_t> m_free;
  std::size_t m_numLeaves = 0;
};

}  // namespace semantic_octree
