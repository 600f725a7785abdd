#pragma once
#include <deque>

#include "Cell.h"
#include "Pools.h"

namespace semantic_octree {

/** The eight children of a node in one piece of memory, behind the array of pointers that OctoMap
 * reads. A null pointer is a child that does not exist (unknown space). */
struct Octant {
  octomap::AbstractOcTreeNode* pointers[8];
  Node nodes[8];

  bool has(int i) const { return pointers[i] != nullptr; }
  /** Makes child i exist; a new one has log-odds 0. */
  Node& child(int i) {
    pointers[i] = &nodes[i];
    return nodes[i];
  }
};

class NodeArena;

/** Memory of a tree: octants, class records, bookkeeping of inner nodes.
 *
 * How nodes are stored is known here, to what writes them (ScanMerger, TreeBuilder, TreeReader) and
 * to what keeps their bookkeeping (GTree). Everything else reads Node::child(). */
class NodeStore {
 public:
  /** \param stateBytes size of an inner node's bookkeeping, 0 for none. */
  explicit NodeStore(std::size_t stateBytes);

  /** Nodes are memory that goes with the store; OctoMap wants to see a node childless when it goes.
   */
  ~NodeStore() { m_root.children = nullptr; }

  Node& root() { return m_root; }

  /** The i-th of the arenas, one per thread; made when first asked for (not thread safe). */
  NodeArena& arena(int i);

  static Octant& octant(const Node& inner) { return *reinterpret_cast<Octant*>(inner.children); }
  /** Brings an inner node's children and bookkeeping nearer to the processor. */
  void prefetchInner(const Node& node) const {
    if (node.isLeaf()) return;
    __builtin_prefetch(node.children);
    __builtin_prefetch(reinterpret_cast<const char*>(node.children) + 64);
    __builtin_prefetch(reinterpret_cast<const char*>(node.children) + 128);
    __builtin_prefetch(state<char>(node));
    __builtin_prefetch(state<char>(node) + 64);
  }
  void prefetchChildren(const Node& inner) const {
    for (const Node& child : octant(inner).nodes) prefetchInner(child);
  }
  /** An inner node is as occupied as its most occupied child. */
  static void updateOccupancy(Node& inner);
  const Belief& record(const Node& leaf) const { return *m_records.at<Belief>(leaf.m_index); }
  Belief& record(const Node& leaf) { return *m_records.at<Belief>(leaf.m_index); }
  /** Bookkeeping of an inner node. */
  template <typename T>
  T* state(const Node& inner) const {
    return m_states.at<T>(inner.m_index);
  }
  std::size_t stateBytes() const { return m_stateBytes; }

  /** Bytes held, without what the heap adds. */
  std::size_t bytes() const { return m_octants.bytes() + m_records.bytes() + m_states.bytes(); }
  /** Nodes including the root. */
  std::size_t numNodes() const;
  std::size_t numInnerNodes() const;

 private:
  friend class NodeArena;
  Node m_root;
  std::size_t m_stateBytes;
  BlockPool<Octant> m_octants;
  RecordPool m_records, m_states;
  std::deque<NodeArena> m_arenas;
};

/** One thread's way to create and remove nodes. */
class NodeArena {
 public:
  explicit NodeArena(NodeStore& store);

  /** Children of a node that has none yet: none of them exists. */
  Octant& createOctant(Node& node);
  /** Children of a leaf, each a copy of it. */
  Octant& expand(Node& leaf);
  /** Turns an inner node into a leaf if its eight children are leaves that agree bit for bit. */
  bool prune(Node& inner);
  /** Makes child i of a node's octant exist. \return the child */
  Node& createChild(Octant& octant, int i) {
    if (!octant.has(i)) ++m_nodes;
    return octant.child(i);
  }
  /** Takes back createChild() of a leaf without a record. */
  void removeChild(Octant& octant, int i) {
    octant.pointers[i] = nullptr;
    --m_nodes;
  }
  /** Takes back createOctant() of a node without children. */
  void removeOctant(Node& node);
  void setRecord(Node& leaf, const Belief& belief);
  void dropRecord(Node& leaf);
  /** Copies everything below `from` (of another store) and its value to the childless node `to`. */
  void copy(const NodeStore& source, const Node& from, Node& to);
  /** Made less removed; an arena may remove what another has made. */
  long nodes() const { return m_nodes; }
  long innerNodes() const { return m_inner; }

 private:
  bool childrenAgree(const Octant& octant) const;

  NodeStore& m_store;
  BlockPool<Octant>::Arena m_octants;
  RecordPool::Arena m_records, m_states;
  long m_nodes = 0, m_inner = 0;
};

}  // namespace semantic_octree
