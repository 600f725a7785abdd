#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "BreadthFirstTree.h"

/** \file
 * The reference for tests: plain G-tree search in any tree, all of it in one pass, with the
 * standard library's logarithms. What runs in a map is semantic_octree's GTree and CompressedTree.
 *
 * The optimal abstraction of a tree: G-tree search, after Larsson, Maity and Tsiotras.
 *
 * Among all trees that arise by pruning, T* maximizes
 *     J(T) = sum_t weight_t I_t(T) - alpha I_X(T) = sum over interior n of p(n) dJ(n),
 *     dJ(n) = sum_t weight_t JS_t(n) - alpha H(Pi_n),
 * where Pi_n are the children's shares of n's weight. From the deepest level up,
 *     G(n) = max(0, V(n)),   V(n) = dJ(n) + sum_c Pi_c G(c),   G(leaf) = 0,
 * and from the roots down a node is expanded where G > eps. With "greater", not "at least", T* is
 * the smallest of all optimal trees, and it does not change if equal leaves are merged beforehand.
 *
 * Several roots: each is optimized by itself and what lies above them is free of charge. */

namespace reference {

/** How JS is computed, see Divergence.h. */
enum class DivergenceForm { Stable, Fast };

struct SearchOptions {
  DivergenceForm divergence = DivergenceForm::Stable;
};

/** The information quantities of all nodes, whatever the weights. */
struct NodeInformation {
  /** p(n), the node's share of the roots' weights. */
  std::vector<double> probability;
  /** H(Pi_n) in nats; 0 for leaves. */
  std::vector<double> splitEntropy;
  /** JS_t(n) in nats, all terms of node 0, then of node 1...; 0 for leaves. */
  std::vector<double> divergence;
};

/** What the weights make of it; one entry per node. */
struct GValues {
  /** p(n) sum_t weight_t JS_t(n) and p(n) H(Pi_n): input for collapseAlphas(). */
  std::vector<double> gain, price;
  /** V(n), and G(n) = max(0, V(n)), both per unit of p(n); 0 for leaves and where p(n) = 0. */
  std::vector<double> v, g;
};

/** The information quantities, all logarithms computed afresh. */
NodeInformation computeInformation(const BreadthFirstTree& tree, const TermRows& terms,
                                   DivergenceForm form = DivergenceForm::Stable);
/** The inverse breadth-first pass over all nodes. */
GValues computeG(const BreadthFirstTree& tree, const NodeInformation& information,
                 const AbstractionWeights& weights);
/** Interior nodes of the smallest optimal tree: reached from a root over nodes of G > eps. */
std::vector<char> expandedNodes(const BreadthFirstTree& tree, const GValues& values, double eps);
/** Measures of the tree with these interior nodes (closed towards the roots). */
TreeMeasures measure(const BreadthFirstTree& tree, const TermRows& terms,
                     const NodeInformation& information, const std::vector<char>& expanded);
/** Share of each term's information that `kept` retains; none where `full` is below 1e-12 nats. */
std::vector<std::optional<double>> retention(const TreeMeasures& kept, const TreeMeasures& full);

/** An optimal tree with all that led to it. Per-node vectors go by the breadth-first index. */
struct SearchResult {
  BreadthFirstTree tree;
  NodeInformation information;
  GValues values;
  /** Interior nodes of T*. */
  std::vector<char> expanded;
  /** J(T*) over J(roots): the sum of p(n) G(n) over the roots. */
  double objective = 0;
  /** The tree of the roots alone (all 0 for a single root), T*, and the whole tree. */
  TreeMeasures roots, optimal, full;
  /** Per term: optimal.information / full.information. */
  std::vector<std::optional<double>> retention;

  /** Node n is a leaf of T*. */
  bool isOptimalLeaf(std::size_t n) const;
};

/** Finds the optimal tree of a tree already laid out. */
SearchResult findOptimalTree(BreadthFirstTree tree, const TermRows& terms,
                             const AbstractionWeights& weights, const SearchOptions& options = {});

/** An optimal tree in the handles of the tree it was found in. */
template <class Node>
struct FoundTree : SearchResult {
  /** Handle of each node. */
  std::vector<Node> nodes;

  std::vector<Node> interior() const {
    return select([this](std::size_t n) { return expanded[n] != 0; });
  }
  std::vector<Node> leaves() const {
    return select([this](std::size_t n) { return isOptimalLeaf(n); });
  }

 private:
  template <class Predicate>
  std::vector<Node> select(const Predicate& wanted) const {
    std::vector<Node> chosen;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (wanted(n)) chosen.push_back(nodes[n]);
    }
    return chosen;
  }
};

/** Finds the smallest tree that maximizes J. For what a Tree must offer see layOutBreadthFirst().
 * \throw std::invalid_argument weights that AbstractionWeights::validate() rejects, a leaf with a
 * bad weight or distribution, or a tree without weight. */
template <class Tree>
FoundTree<typename Tree::Node> findOptimalTree(const Tree& tree, const AbstractionWeights& weights,
                                               const SearchOptions& options = {}) {
  const TermRows terms(weights, tree.numClasses());
  FoundTree<typename Tree::Node> result;
  BreadthFirstTree flat = layOutBreadthFirst(tree, terms, result.nodes);
  static_cast<SearchResult&>(result) = findOptimalTree(std::move(flat), terms, weights, options);
  return result;
}

}  // namespace reference
