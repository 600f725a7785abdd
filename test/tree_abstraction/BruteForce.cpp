#include "BruteForce.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brute_force {
namespace {

using reference::Forest;
using tree_abstraction::AbstractionWeights;
using tree_abstraction::InformationTerm;
using Node = std::int32_t;

/** p(n, class) for all nodes: summed over the leaves below, over the total weight. */
class Joint {
 public:
  explicit Joint(const Forest& tree) {
    double total = 0;
    std::size_t classes = 0;
    for (const auto& node : tree.nodes) classes = std::max(classes, node.distribution.size());
    m_table.assign(tree.size(), std::vector<double>(classes));
    for (Node n = 0; n < static_cast<Node>(tree.size()); ++n) {
      const Forest::Node& leaf = tree[n];
      if (!leaf.children.empty()) continue;
      total += leaf.weight;
      for (Node up = n; up != Forest::kNoParent; up = tree[up].parent) {
        for (std::size_t k = 0; k < classes; ++k) at(up)[k] += leaf.weight * leaf.distribution[k];
      }
    }
    for (auto& row : m_table) {
      for (double& x : row) x /= total;
    }
  }
  const std::vector<double>& operator[](Node n) const {
    return m_table[static_cast<std::size_t>(n)];
  }

 private:
  std::vector<double>& at(Node n) { return m_table[static_cast<std::size_t>(n)]; }
  std::vector<std::vector<double>> m_table;
};

double sum(const std::vector<double>& p) {
  double total = 0;
  for (const double x : p) total += x;
  return total;
}

/** Probabilities of the term's outcomes, the rest last. */
std::vector<double> outcomes(const std::vector<double>& classes, const InformationTerm& term) {
  std::vector<double> p, rest = classes;
  for (const auto& group : term.groups) {
    p.push_back(0);
    for (const int id : group) {
      p.back() += classes[static_cast<std::size_t>(id)];
      rest[static_cast<std::size_t>(id)] = 0;
    }
  }
  p.push_back(sum(rest));
  return p;
}

/** What leaf n adds to J: sum_t w_t p(n) KL(p(y|n) || p(y)) + alpha p(n) ln p(n). */
class LeafShares {
 public:
  LeafShares(const Forest& tree, const AbstractionWeights& weights) : m_share(tree.size()) {
    const Joint joint(tree);
    std::vector<double> all(joint[0].size());
    for (const Node root : tree.roots) {
      for (std::size_t k = 0; k < all.size(); ++k) all[k] += joint[root][k];
    }
    for (Node n = 0; n < static_cast<Node>(tree.size()); ++n) {
      const double p = sum(joint[n]);
      if (p == 0) continue;
      double& share = m_share[static_cast<std::size_t>(n)] = weights.alpha * p * std::log(p);
      for (const auto& term : weights.terms) {
        const auto here = outcomes(joint[n], term), everywhere = outcomes(all, term);
        for (std::size_t y = 0; y < here.size(); ++y) {
          if (here[y] > 0) share += term.weight * here[y] * std::log(here[y] / p / everywhere[y]);
        }
      }
    }
  }
  double operator[](Node n) const { return m_share[static_cast<std::size_t>(n)]; }

 private:
  std::vector<double> m_share;
};

struct PrunedTree {
  std::uint64_t interior;
  double objective;
};
using PrunedTrees = std::vector<PrunedTree>;

PrunedTrees combine(const PrunedTrees& a, const PrunedTrees& b) {
  PrunedTrees both;
  both.reserve(a.size() * b.size());
  for (const auto& x : a) {
    for (const auto& y : b) both.push_back({x.interior | y.interior, x.objective + y.objective});
  }
  return both;
}

class Enumeration {
 public:
  Enumeration(const Forest& tree, const AbstractionWeights& weights)
      : m_tree(tree), m_shares(tree, weights) {}

  PrunedTrees ofForest() {
    PrunedTrees trees{{0, 0.0}};
    for (const Node root : m_tree.roots) {
      auto ofRoot = below(root);
      for (auto& t : ofRoot) t.objective -= m_shares[root];
      trees = combine(trees, ofRoot);
    }
    return trees;
  }
  std::vector<Node> nodes(std::uint64_t mask) const {
    std::vector<Node> chosen;
    for (std::size_t bit = 0; bit < m_inner.size(); ++bit) {
      if (mask >> bit & 1) chosen.push_back(m_inner[bit]);
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

 private:
  PrunedTrees below(Node n) {
    PrunedTrees trees{{0, m_shares[n]}};
    if (m_tree[n].children.empty()) return trees;
    if (m_inner.size() == 64) throw std::logic_error("brute force: more than 64 inner nodes");
    PrunedTrees expanded{{std::uint64_t{1} << m_inner.size(), 0.0}};
    m_inner.push_back(n);
    for (const Node child : m_tree[n].children) expanded = combine(expanded, below(child));
    trees.insert(trees.end(), expanded.begin(), expanded.end());
    return trees;
  }

  const Forest& m_tree;
  const LeafShares m_shares;
  std::vector<Node> m_inner;
};

double countBelow(const Forest& tree, Node n) {
  if (tree[n].children.empty()) return 1;
  double product = 1;
  for (const Node child : tree[n].children) product *= countBelow(tree, child);
  return 1 + product;
}

}  // namespace

double countTrees(const Forest& tree) {
  double product = 1;
  for (const Node root : tree.roots) product *= countBelow(tree, root);
  return product;
}

double objective(const Forest& tree, const AbstractionWeights& weights,
                 const std::vector<Node>& interior) {
  const LeafShares shares(tree, weights);
  double j = 0;
  for (const Node root : tree.roots) j -= shares[root];
  const auto isInterior = [&](Node n) {
    return std::find(interior.begin(), interior.end(), n) != interior.end();
  };
  for (Node n = 0; n < static_cast<Node>(tree.size()); ++n) {
    const bool reached = tree[n].parent == Forest::kNoParent || isInterior(tree[n].parent);
    if (reached && !isInterior(n)) j += shares[n];
  }
  return j;
}

Optimum optimize(const Forest& tree, const AbstractionWeights& weights) {
  Enumeration enumeration(tree, weights);
  const PrunedTrees trees = enumeration.ofForest();
  Optimum best;
  best.numTrees = trees.size();
  best.objective = trees.front().objective;
  for (const auto& t : trees) best.objective = std::max(best.objective, t.objective);
  std::uint64_t inAll = ~std::uint64_t{0};
  const auto isOptimal = [&](const PrunedTree& t) { return t.objective > best.objective - 1e-13; };
  for (const auto& t : trees) {
    if (!isOptimal(t)) continue;
    ++best.numOptimal;
    inAll &= t.interior;
  }
  best.inAll = enumeration.nodes(inAll);
  best.intersectionIsOptimal = std::any_of(trees.begin(), trees.end(), [&](const PrunedTree& t) {
    return isOptimal(t) && t.interior == inAll;
  });
  return best;
}

}  // namespace brute_force
