#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include <array>
#include <cstdint>

#include "Cell.h"
#include "CheckedStream.h"

namespace semantic_octree {

class NodeArena;

/** A map's bytes: kMagic, kVersion, then in checked blocks (see CheckedStream.h)
 *   resolution (double), pruning (1 byte), filter (increments 1 byte, six doubles),
 *   classes: number (1 byte), each name (2 bytes length, characters), r, g, b,
 *            policy for unknown raw ids (1 byte), folds (4 bytes number; raw id 4 bytes, class 1
 * byte), number of nodes (8 bytes; 0: the map is empty), the root's NodeKind (1 byte) and value,
 * then from each inner node on, depth first: two bits of NodeKind per child (2 bytes), the leaves'
 * values, the inner children. The value of a leaf is its log-odds (float); with a class record,
 * followed by the number of named classes (1 byte), the rest's log-odds, and id (1 byte) and
 * log-odds of each. Inner nodes' values follow from their children. */
constexpr std::array<char, 8> kMagic{'S', 'E', 'M', 'O', 'C', 'T', 'R', 'E'};
constexpr std::uint32_t kVersion = 1;

enum class NodeKind : std::uint8_t { None, Leaf, LeafWithRecord, Inner };

/** Writes a map's content after magic and version. */
class TreeWriter {
 public:
  TreeWriter(std::ostream& out, const SemanticOcTree& tree) : m_out(out), m_tree(tree) {}
  void write();

 private:
  void putParameters(const FilterParameters& p);
  void putClasses(const ClassTable& classes);
  void putLeaf(const Node& leaf);
  void putChildren(const Node& inner);
  static NodeKind kindOf(const Node& node);

  CheckedWriter m_out;
  const SemanticOcTree& m_tree;
};

/** Reads a map's content after magic and version. What the checksums let pass is
 * checked too, so that no input leads to a broken tree.
 * \throw std::runtime_error, std::invalid_argument (bad parameters or classes). */
class TreeReader {
 public:
  explicit TreeReader(std::istream& in) : m_in(in) {}
  SemanticOcTree read();

 private:
  FilterParameters getParameters();
  ClassTable getClasses();
  void getNodes(SemanticOcTree& tree, std::uint64_t expectedNodes);
  void getNode(Node& node, NodeKind kind, int depth);
  void getRecord(Node& leaf);
  void getChildren(Node& inner, int depth);
  /** One byte, 0 to `last`. */
  std::uint8_t getUpTo(int last, const char* what);
  float getLogOdds();

  CheckedReader m_in;
  NodeStore* m_store = nullptr;
  NodeArena* m_arena = nullptr;
  int m_numClasses = 0;
};

}  // namespace semantic_octree
