#pragma once
#include <cstdint>
#include <vector>

namespace reference {

/** A forest in memory, of any arity, whose leaves hold a weight and a class distribution. For small
 * trees made by hand; offers what layOutBreadthFirst() asks of a tree. */
class VectorTree {
 public:
  using Node = std::int32_t;
  static constexpr Node kNoParent = -1;

  /** \param numClasses K; distributions have K + 1 entries, free space first.
   * \throw std::invalid_argument K < 0. */
  explicit VectorTree(int numClasses);

  /** Adds a root (kNoParent) or a child, after the children there are. It needs children of its
   * own, or is to be added with addLeaf() or addMissing(). \throw std::invalid_argument `parent` is
   * not an inner node of this tree. */
  Node addInner(Node parent);
  /** Adds a leaf that was observed. \throw std::invalid_argument as addInner(). */
  Node addLeaf(Node parent, double weight, std::vector<double> distribution);
  /** Adds a leaf for space nobody observed. \throw std::invalid_argument as addInner(). */
  Node addMissing(Node parent, double weight, std::vector<double> distribution);

  std::size_t size() const { return m_items.size(); }
  Node parent(Node n) const { return item(n).parent; }
  const std::vector<Node>& children(Node n) const { return item(n).children; }
  const std::vector<Node>& roots() const { return m_roots; }

  int numClasses() const { return m_numClasses; }
  bool isKnown(Node leaf) const { return item(leaf).kind != Kind::Missing; }
  /** \throw std::logic_error an inner node to which no child was added. */
  double weight(Node leaf) const;
  void distribution(Node leaf, std::vector<double>& p) const { p = item(leaf).distribution; }

  template <class F>
  void forEachRoot(const F& f) const {
    for (const Node n : m_roots) f(n);
  }
  template <class F>
  void forEachChild(Node n, const F& f) const {
    for (const Node child : item(n).children) f(child);
  }

 private:
  enum class Kind { Inner, Known, Missing };
  struct Item {
    Kind kind;
    Node parent;
    double weight;
    std::vector<double> distribution;
    std::vector<Node> children;
  };
  const Item& item(Node n) const { return m_items.at(static_cast<std::size_t>(n)); }
  Node add(Item item);

  int m_numClasses;
  std::vector<Node> m_roots;
  std::vector<Item> m_items;
};

}  // namespace reference
