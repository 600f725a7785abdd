#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include "CheckedStream.h"
#include "NodeStore.h"
#include "TreeFormat.h"

namespace semantic_octree {

/** Reads a map's content (see TreeFormat.h) after magic and version. What the checksums let pass is
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
