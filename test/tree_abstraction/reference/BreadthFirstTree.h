#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "Divergence.h"

namespace reference {

/** A forest laid out breadth first in flat arrays, one entry per node: roots first, level by level,
 * the children of a node side by side. A child's index is above its parent's. */
struct BreadthFirstTree {
  static constexpr std::int32_t kNoParent = -1;

  std::size_t numRoots = 0;
  std::vector<std::int32_t> parent;
  /** Index of the first child (any value for a leaf) and number of children (0: a leaf). */
  std::vector<std::int32_t> firstChild, numChildren;
  /** Known leaves, and inner nodes above one. */
  std::vector<char> known;
  /** Weight w(n), any unit: an inner node's is the sum of its children's. */
  std::vector<double> weight;
  /** Outcome probabilities of the terms, rowWidth doubles a node: see TermRows. */
  std::size_t rowWidth = 0;
  std::vector<double> rows;

  std::size_t size() const { return parent.size(); }
  bool isLeaf(std::size_t n) const { return numChildren[n] == 0; }
  const double* row(std::size_t n) const { return rows.data() + n * rowWidth; }
  /** Sum of the roots' weights. */
  double totalWeight() const;

  /** Appends a node without children. */
  void append(std::int32_t parentIndex, bool isKnown);
  /** Stores a leaf's weight and row.
   * \throw std::invalid_argument naming the node: weight negative or not finite; `distribution` not
   * K + 1 numbers >= 0 of sum 1 (to 1e-9). */
  void setLeaf(std::size_t n, double leafWeight, const std::vector<double>& distribution,
               const TermRows& terms);
  /** Fills in weight, row and `known` of the inner nodes from their children, deepest first.
   * Children mix by weight; if none has any, evenly. */
  void aggregate();
};

/** Shares of n children in their common weight: of sum 1, and equal if none has any weight. */
void shares(const double* weights, std::size_t n, std::vector<double>& pi);

/** Lays out a tree. `nodes[i]` becomes the tree's own handle of node i.
 *
 * Tree is any type with
 *   - `Node`: a handle that can be copied;
 *   - `int numClasses() const`: K;
 *   - `forEachRoot(f) const` and `forEachChild(Node, f) const`: call f(Node), in a fixed order;
 *   - `bool isKnown(Node leaf) const`: false for missing children;
 *   - `double weight(Node leaf) const`: >= 0, for instance the volume;
 *   - `void distribution(Node leaf, std::vector<double>& p) const`: the K + 1 probabilities.
 * A node without children is a leaf; arity and depth are free. A missing child is handed out as a
 * leaf, too, or left out if it has no weight. */
template <class Tree>
BreadthFirstTree layOutBreadthFirst(const Tree& tree, const TermRows& terms,
                                    std::vector<typename Tree::Node>& nodes) {
  using Node = typename Tree::Node;
  BreadthFirstTree flat;
  flat.rowWidth = terms.width();
  nodes.clear();
  const auto add = [&](std::int32_t parent, const Node& node) {
    nodes.push_back(node);
    flat.append(parent, false);
  };
  tree.forEachRoot([&](const Node& root) { add(BreadthFirstTree::kNoParent, root); });
  flat.numRoots = nodes.size();
  std::vector<double> p;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto first = static_cast<std::int32_t>(nodes.size());
    const Node node = nodes[n];  // a copy: `nodes` grows below
    tree.forEachChild(node, [&](const Node& child) { add(static_cast<std::int32_t>(n), child); });
    flat.firstChild[n] = first;
    flat.numChildren[n] = static_cast<std::int32_t>(nodes.size()) - first;
    if (!flat.isLeaf(n)) continue;
    tree.distribution(node, p);
    flat.known[n] = tree.isKnown(node);
    flat.setLeaf(n, tree.weight(node), p, terms);
  }
  flat.aggregate();
  return flat;
}

}  // namespace reference
