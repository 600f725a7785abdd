#pragma once
#include <tree_abstraction/AbstractionWeights.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

/** \file
 * The optimal abstraction of a tree as its paper has it: G-tree search, after Larsson, Maity and
 * Tsiotras. It is written to be read, and the map's own search (semantic_octree's GTree and
 * CompressedTree) is tested against it.
 *
 * Among all trees that arise by pruning, T* maximizes
 *
 *     J(T) = sum_t weight_t I_t(T) - alpha I_X(T) = sum over interior n of p(n) dJ(n),
 *     dJ(n) = sum_t weight_t JS_t(n) - alpha H(Pi_n),
 *
 * where Pi_n are the children's shares of n's weight, and JS_t(n) is the Jensen-Shannon divergence
 * of the children's distributions of term t: what is lost when they are merged. From the deepest
 * level up,
 *
 *     G(n) = max(0, V(n)),   V(n) = dJ(n) + sum_c Pi_c G(c),   G(leaf) = 0,
 *
 * and from the roots down a node is expanded where G > eps. With "greater", not "at least", T* is
 * the smallest of all optimal trees.
 *
 * Several roots: each is optimized by itself, and what lies above them is free of charge. */

namespace reference {

/** A forest of any arity whose leaves hold a weight and a class distribution. A node's number is
 * above its parent's. */
struct Forest {
  static constexpr std::int32_t kNoParent = -1;

  struct Node {
    std::int32_t parent = kNoParent;
    bool known = false;                ///< an observed leaf, or above one
    double weight = 0;                 ///< of an inner node: the sum of its children's
    std::vector<double> distribution;  ///< K + 1 probabilities; of an inner node: the mixture
    std::vector<std::int32_t> children;
  };
  std::vector<Node> nodes;
  std::vector<std::int32_t> roots;

  /** Adds a root (kNoParent) or a child, behind the children there are. */
  std::int32_t addInner(std::int32_t parent) { return add({parent, false, 0, {}, {}}); }
  /** Adds a leaf that was observed. */
  std::int32_t addLeaf(std::int32_t parent, double weight, std::vector<double> distribution) {
    return add({parent, true, weight, std::move(distribution), {}});
  }
  /** Adds a leaf for space nobody observed. */
  std::int32_t addMissing(std::int32_t parent, double weight, std::vector<double> distribution) {
    return add({parent, false, weight, std::move(distribution), {}});
  }
  const Node& operator[](std::int32_t n) const { return nodes[static_cast<std::size_t>(n)]; }
  std::size_t size() const { return nodes.size(); }

 private:
  std::int32_t add(Node node);
};

/** What the search found out about a node. */
struct NodeValues {
  double probability = 0;          ///< p(n): the share of the roots' weight
  double splitEntropy = 0;         ///< H(Pi_n), nats
  std::vector<double> divergence;  ///< JS_t(n), nats, one for each term
  double v = 0, g = 0;             ///< V(n) and G(n), for each unit of p(n)
  bool expanded = false;           ///< an interior node of T*
  bool reached = false;            ///< a node of T*, interior or leaf
};

/** An optimal tree, with all that led to it. */
struct SearchResult {
  Forest forest;
  std::vector<NodeValues> values;  ///< by node
  /** J(T*) over J(roots): the sum of p(n) G(n) over the roots. */
  double objective = 0;
  /** Measures of the roots alone (all 0 for a single root), of T*, and of the whole forest. */
  tree_abstraction::TreeMeasures roots, optimal, full;

  std::vector<std::int32_t> interior() const;
  std::vector<std::int32_t> leaves() const;
  /** By node: whether T* expands it. */
  std::vector<char> expanded() const;
  /** By node: what tree_abstraction::collapseAlphas() takes. */
  std::vector<std::int32_t> parents() const;
  std::vector<double> gains(const tree_abstraction::AbstractionWeights& weights) const;
  std::vector<double> prices() const;
};

/** Finds the smallest tree that maximizes J. \param forest some leaf has a weight above 0, and all
 * distributions as many entries \throw std::invalid_argument weights that do not fit */
SearchResult findOptimalTree(Forest forest, const tree_abstraction::AbstractionWeights& weights);

/** Measures of the tree that expands these nodes (closed towards the roots). */
tree_abstraction::TreeMeasures measuresOf(const SearchResult& found,
                                          const tree_abstraction::AbstractionWeights& weights,
                                          const std::vector<char>& expanded);

}  // namespace reference
