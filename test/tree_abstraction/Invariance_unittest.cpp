#include <gtest/gtest.h>
#include <reference/GTreeSearch.h>

#include <algorithm>
#include <map>

#include "BruteForce.h"
#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;
using random_trees::Engine;
using random_trees::Shape;
using Node = VectorTree::Node;

namespace {

/** Copies of a tree with a change, remembering which node became which. */
class Copier {
 public:
  explicit Copier(const VectorTree& from) : m_from(from), m_to(from.numClasses()) {}

  template <class CopyChildren>
  VectorTree copy(const CopyChildren& copyChildren) {
    copyNode(0, VectorTree::kNoParent, copyChildren);
    return m_to;
  }
  const std::map<Node, Node>& originals() const { return m_originals; }

  void copyLeaf(Node leaf, Node parent, double factor) {
    std::vector<double> p;
    m_from.distribution(leaf, p);
    m_originals[m_to.addLeaf(parent, factor * m_from.weight(leaf), p)] = leaf;
  }
  template <class CopyChildren>
  void copyNode(Node n, Node parent, const CopyChildren& copyChildren) {
    if (m_from.children(n).empty()) return copyLeaf(n, parent, 1.0);
    const Node inner = m_to.addInner(parent);
    m_originals[inner] = n;
    copyChildren(*this, n, inner);
  }
  /** A leaf becomes a subtree of equal leaves: what pruning would undo. */
  void copyLeafUnpruned(Node leaf, Node parent, int levels) {
    if (levels == 0) return copyLeaf(leaf, parent, m_factor);
    const Node inner = m_to.addInner(parent);
    m_originals[inner] = leaf;
    m_factor /= 8;
    for (int i = 0; i < 8; ++i) copyLeafUnpruned(leaf, inner, levels - 1);
    m_factor *= 8;
  }

 private:
  const VectorTree& m_from;
  VectorTree m_to;
  std::map<Node, Node> m_originals;
  double m_factor = 1.0;
};

struct Example {
  VectorTree tree;
  AbstractionWeights weights;
};

Example makeExample(unsigned seed) {
  Engine random(seed);
  const Shape shape{4, 8, 8, 0.4};
  auto tree = random_trees::makeTree(shape, random);
  auto weights = random_trees::makeWeights(shape, random);
  return {std::move(tree), std::move(weights)};
}

std::vector<Node> sortedOriginals(const std::vector<Node>& nodes, const Copier& copier) {
  std::vector<Node> originals;
  for (const Node n : nodes) originals.push_back(copier.originals().at(n));
  std::sort(originals.begin(), originals.end());
  return originals;
}

std::vector<Node> sorted(std::vector<Node> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

TEST(Invariance, scalingAllWeightsScalesTheObjectiveAndKeepsTheTree) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto [tree, weights] = makeExample(seed);
    const auto found = findOptimalTree(tree, weights);
    for (const double factor : {1e-6, 0.1, 7.0, 1e9}) {
      auto scaled = weights;
      scaled.alpha *= factor;
      for (auto& term : scaled.terms) term.weight *= factor;
      const auto again = findOptimalTree(tree, scaled);
      EXPECT_EQ(again.expanded, found.expanded);
      EXPECT_NEAR(again.objective, factor * found.objective, 1e-12 * factor);
    }
  }
}

TEST(Invariance, theUnitOfWeightDoesNotMatter) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto [tree, weights] = makeExample(seed);
    Copier copier(tree);
    const auto scaleLeaves = [&, &tree = tree](auto& self, Copier& c, Node n, Node inner) -> void {
      for (const Node child : tree.children(n)) {
        if (tree.children(child).empty()) {
          c.copyLeaf(child, inner, 1000.0);
        } else {
          c.copyNode(child, inner, [&](Copier& cc, Node m, Node i) { self(self, cc, m, i); });
        }
      }
    };
    const auto heavy =
        copier.copy([&](Copier& c, Node n, Node inner) { scaleLeaves(scaleLeaves, c, n, inner); });
    const auto found = findOptimalTree(tree, weights), again = findOptimalTree(heavy, weights);
    EXPECT_EQ(sortedOriginals(again.interior(), copier), sorted(found.interior()));
    EXPECT_NEAR(again.objective, found.objective, 1e-13);
  }
}

TEST(Invariance, theOrderOfChildrenDoesNotMatter) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto [tree, weights] = makeExample(seed);
    Copier copier(tree);
    const auto reverse = [&, &tree = tree](auto& self, Copier& c, Node n, Node inner) -> void {
      auto children = tree.children(n);
      std::reverse(children.begin(), children.end());
      std::swap(children.front(), children[children.size() / 2]);
      for (const Node child : children) {
        c.copyNode(child, inner, [&](Copier& cc, Node m, Node i) { self(self, cc, m, i); });
      }
    };
    const auto permuted =
        copier.copy([&](Copier& c, Node n, Node inner) { reverse(reverse, c, n, inner); });
    const auto found = findOptimalTree(tree, weights), again = findOptimalTree(permuted, weights);
    EXPECT_EQ(sortedOriginals(again.interior(), copier), sorted(found.interior()));
    EXPECT_NEAR(again.objective, found.objective, 1e-13);
  }
}

TEST(Invariance, mergingEqualLeavesBeforehandChangesNothingBitForBit) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto [tree, weights] = makeExample(seed);
    Copier copier(tree);
    const auto unprune = [&, &tree = tree](auto& self, Copier& c, Node n, Node inner) -> void {
      for (const Node child : tree.children(n)) {
        if (tree.children(child).empty()) {
          c.copyLeafUnpruned(child, inner, child % 3);
        } else {
          c.copyNode(child, inner, [&](Copier& cc, Node m, Node i) { self(self, cc, m, i); });
        }
      }
    };
    const auto unpruned =
        copier.copy([&](Copier& c, Node n, Node inner) { unprune(unprune, c, n, inner); });
    ASSERT_GT(unpruned.size(), tree.size());
    for (const auto form : {DivergenceForm::Stable, DivergenceForm::Fast}) {
      const auto found = findOptimalTree(tree, weights, {form});
      const auto again = findOptimalTree(unpruned, weights, {form});
      EXPECT_EQ(sortedOriginals(again.interior(), copier), sorted(found.interior()));
      EXPECT_EQ(again.objective, found.objective);
      for (std::size_t t = 0; t < weights.terms.size(); ++t) {
        EXPECT_NEAR(again.full.information[t], found.full.information[t], 1e-14);
      }
    }
  }
}

TEST(Invariance, informationOfTheTreeFollowsTheChainRuleAndDataProcessing) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto [tree, weights] = makeExample(seed);
    AbstractionWeights measures{{wholeClassVariable("all", 1, 2), relevant("one", 1, {1})}, 0.1};
    const auto found = findOptimalTree(tree, measures);
    // Chain rule: the sum over interior nodes is the entropy at the root less that of the leaves.
    const TermRows terms(measures, 2);
    for (std::size_t t = 0; t < 2; ++t) {
      double left = terms.entropy(t, found.tree.row(0));
      for (std::size_t n = 0; n < found.tree.size(); ++n) {
        if (found.isOptimalLeaf(n)) {
          left -= found.information.probability[n] * terms.entropy(t, found.tree.row(n));
        }
      }
      EXPECT_NEAR(found.optimal.information[t], left, 1e-13);
    }
    EXPECT_LE(found.optimal.information[0], found.full.information[0]);
    EXPECT_LE(found.full.information[1], found.full.information[0] + 1e-15);
    EXPECT_LE(found.full.information[0], found.full.leafEntropy);
  }
}

namespace {

/** G(n) of the paper, not divided by p(n): the most that subtrees of n add to J. From the values of
 * whole trees alone. \param above the interior nodes on the way to n */
double unnormalizedG(const VectorTree& tree, const AbstractionWeights& weights, Node node,
                     std::vector<Node> above, std::map<Node, double>& all) {
  if (tree.children(node).empty()) return all[node] = 0;
  const double without = brute_force::objective(tree, weights, above);
  above.push_back(node);
  double value = brute_force::objective(tree, weights, above) - without;
  for (const auto child : tree.children(node))
    value += unnormalizedG(tree, weights, child, above, all);
  return all[node] = std::max(value, 0.0);
}

}  // namespace

/** Proposition 1: what is expanded may be decided without p(n), by the children's shares alone. */
TEST(Invariance, gIsPositiveWhereGPerUnitOfProbabilityIs) {
  int positive = 0, zero = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Engine random(seed);
    Shape shape{3, 8, 8, 0.5};
    shape.missingProbability = 0.3;
    const auto tree = random_trees::makeTree(shape, random);
    const auto weights = random_trees::makeWeights(shape, random);
    const auto found = findOptimalTree(tree, weights);
    std::map<Node, double> g;
    unnormalizedG(tree, weights, tree.roots().front(), {}, g);
    for (std::size_t n = 0; n < found.nodes.size(); ++n) {
      const double p = found.information.probability[n];
      EXPECT_NEAR(g.at(found.nodes[n]), p * found.values.g[n], 1e-13);
      const double perUnit = found.values.g[n];
      if (p <= 1e-4 || tree.children(found.nodes[n]).empty()) continue;
      if (perUnit > 0 && perUnit < 1e-6) continue;  // brute force rounds
      EXPECT_EQ(g.at(found.nodes[n]) > 1e-12, perUnit > 0);
      ++(perUnit > 0 ? positive : zero);
    }
  }
  EXPECT_GT(positive, 100);
  EXPECT_GT(zero, 100);
}
