#pragma once
#include <semantic_octree/SemanticOcTree.h>

#include "CheckedStream.h"
#include "TreeFormat.h"

namespace semantic_octree {

/** Writes a map's content (see TreeFormat.h) after magic and version. */
class TreeWriter {
 public:
  TreeWriter(std::ostream& out, const SemanticOcTree& tree) : m_out(out), m_tree(tree) {}
  void write();

 private:
  using Node = SemanticOcTreeNode;
  void putParameters(const FilterParameters& p);
  void putClasses(const ClassTable& classes);
  void putLeaf(const Node& leaf);
  void putChildren(const Node& inner);
  static NodeKind kindOf(const Node& node);

  CheckedWriter m_out;
  const SemanticOcTree& m_tree;
};

}  // namespace semantic_octree
