#include "GTreeSearch.h"

#include <algorithm>
#include <stdexcept>

namespace reference {
namespace {

/** The children of a node as pointers into the tree, with their shares of its weight. */
struct Family {
  std::size_t first, count;
  std::vector<double> pi;

  void load(const BreadthFirstTree& tree, std::size_t firstIndex, std::size_t size) {
    first = firstIndex;
    count = size;
    shares(tree.weight.data() + first, count, pi);
  }
  void loadChildren(const BreadthFirstTree& tree, std::size_t n) {
    load(tree, static_cast<std::size_t>(tree.firstChild[n]),
         static_cast<std::size_t>(tree.numChildren[n]));
  }
  double splitEntropy() const { return entropy(pi.data(), count); }
};

/** JS in the fast form: entropies of all nodes first, then differences. */
class KeptEntropies {
 public:
  KeptEntropies(const BreadthFirstTree& tree, const TermRows& terms)
      : m_tree(tree), m_terms(terms), m_entropies(tree.size() * terms.size()) {
    for (std::size_t n = 0; n < tree.size(); ++n) {
      for (std::size_t t = 0; t < terms.size(); ++t) {
        m_entropies[n * terms.size() + t] = terms.entropy(t, tree.row(n));
      }
    }
  }
  double divergence(std::size_t term, std::size_t n, const Family& family) const {
    const auto [offset, width] = m_terms.slot(term);
    const double* children = m_tree.row(family.first) + offset;
    if (allEqual(family.pi.data(), children, family.count, width, m_tree.rowWidth)) return 0.0;
    const std::size_t stride = m_terms.size();
    return entropyDrop(m_entropies[n * stride + term], family.pi.data(),
                       m_entropies.data() + family.first * stride + term, family.count, stride);
  }

 private:
  const BreadthFirstTree& m_tree;
  const TermRows& m_terms;
  std::vector<double> m_entropies;
};

template <class Divergence>
NodeInformation forEachInnerNode(const BreadthFirstTree& tree, std::size_t numTerms,
                                 const Divergence& divergence) {
  NodeInformation information;
  information.probability.resize(tree.size());
  information.splitEntropy.resize(tree.size());
  information.divergence.resize(tree.size() * numTerms);
  const double total = tree.totalWeight();
  Family family;
  for (std::size_t n = tree.size(); n-- > 0;) {
    information.probability[n] = tree.weight[n] / total;
    if (tree.isLeaf(n) || tree.weight[n] <= 0) continue;
    family.loadChildren(tree, n);
    information.splitEntropy[n] = family.splitEntropy();
    for (std::size_t t = 0; t < numTerms; ++t) {
      information.divergence[n * numTerms + t] = divergence(t, n, family);
    }
  }
  return information;
}

/** Measures of the tree whose leaves are the roots. */
TreeMeasures measureRoots(const BreadthFirstTree& tree, const TermRows& terms) {
  TreeMeasures measures;
  Family roots;
  roots.load(tree, 0, tree.numRoots);
  measures.leafEntropy = roots.splitEntropy();
  for (std::size_t t = 0; t < terms.size(); ++t) {
    measures.information.push_back(terms.divergence(t, roots.pi.data(), tree.row(0), roots.count));
  }
  return measures;
}

bool isReached(const BreadthFirstTree& tree, const std::vector<char>& expanded, std::size_t n) {
  return tree.parent[n] == BreadthFirstTree::kNoParent ||
         expanded[static_cast<std::size_t>(tree.parent[n])];
}

}  // namespace

NodeInformation computeInformation(const BreadthFirstTree& tree, const TermRows& terms,
                                   DivergenceForm form) {
  if (form == DivergenceForm::Fast) {
    const KeptEntropies kept(tree, terms);
    return forEachInnerNode(tree, terms.size(), [&](std::size_t t, std::size_t n, const Family& f) {
      return kept.divergence(t, n, f);
    });
  }
  return forEachInnerNode(tree, terms.size(), [&](std::size_t t, std::size_t, const Family& f) {
    return terms.divergence(t, f.pi.data(), tree.row(f.first), f.count);
  });
}

GValues computeG(const BreadthFirstTree& tree, const NodeInformation& information,
                 const AbstractionWeights& weights) {
  const std::size_t size = tree.size(), numTerms = weights.terms.size();
  GValues values;
  for (auto* v : {&values.gain, &values.price, &values.v, &values.g}) v->assign(size, 0.0);
  for (std::size_t n = size; n-- > 0;) {
    if (tree.isLeaf(n) || tree.weight[n] <= 0) continue;
    double gain = 0;
    for (std::size_t t = 0; t < numTerms; ++t) {
      gain += weights.terms[t].weight * information.divergence[n * numTerms + t];
    }
    const std::size_t first = static_cast<std::size_t>(tree.firstChild[n]);
    const double below = pairwiseSum(static_cast<std::size_t>(tree.numChildren[n]), [&](auto i) {
      return tree.weight[first + i] / tree.weight[n] * values.g[first + i];
    });
    values.gain[n] = information.probability[n] * gain;
    values.price[n] = information.probability[n] * information.splitEntropy[n];
    values.v[n] = gain - weights.alpha * information.splitEntropy[n] + below;
    values.g[n] = std::max(0.0, values.v[n]);
  }
  return values;
}

std::vector<char> expandedNodes(const BreadthFirstTree& tree, const GValues& values, double eps) {
  std::vector<char> expanded(tree.size(), false);
  for (std::size_t n = 0; n < tree.size(); ++n) {
    expanded[n] = isReached(tree, expanded, n) && values.g[n] > eps;
  }
  return expanded;
}

TreeMeasures measure(const BreadthFirstTree& tree, const TermRows& terms,
                     const NodeInformation& information, const std::vector<char>& expanded) {
  TreeMeasures measures = measureRoots(tree, terms);
  for (std::size_t n = 0; n < tree.size(); ++n) {
    if (!isReached(tree, expanded, n)) continue;
    if (!expanded[n]) {
      ++measures.numLeaves;
      measures.numKnownLeaves += tree.known[n] ? 1 : 0;
      continue;
    }
    const double p = information.probability[n];
    measures.leafEntropy += p * information.splitEntropy[n];
    for (std::size_t t = 0; t < terms.size(); ++t) {
      measures.information[t] += p * information.divergence[n * terms.size() + t];
    }
  }
  return measures;
}

std::vector<std::optional<double>> retention(const TreeMeasures& kept, const TreeMeasures& full) {
  constexpr double kNothing = 1e-12;
  std::vector<std::optional<double>> ratios(full.information.size());
  for (std::size_t t = 0; t < ratios.size(); ++t) {
    if (full.information[t] >= kNothing) ratios[t] = kept.information[t] / full.information[t];
  }
  return ratios;
}

bool SearchResult::isOptimalLeaf(std::size_t n) const {
  return !expanded[n] && isReached(tree, expanded, n);
}

SearchResult findOptimalTree(BreadthFirstTree tree, const TermRows& terms,
                             const AbstractionWeights& weights, const SearchOptions& options) {
  if (!(tree.totalWeight() > 0)) {
    throw std::invalid_argument("findOptimalTree: the tree's weight is 0, expected some leaf > 0");
  }
  SearchResult result;
  result.tree = std::move(tree);
  result.information = computeInformation(result.tree, terms, options.divergence);
  result.values = computeG(result.tree, result.information, weights);
  result.expanded = expandedNodes(result.tree, result.values, weights.eps());

  std::vector<char> none(result.tree.size(), false), all(result.tree.size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = !result.tree.isLeaf(n);
  result.roots = measure(result.tree, terms, result.information, none);
  result.optimal = measure(result.tree, terms, result.information, result.expanded);
  result.full = measure(result.tree, terms, result.information, all);
  result.retention = retention(result.optimal, result.full);
  for (std::size_t n = 0; n < result.tree.numRoots; ++n) {
    result.objective += result.information.probability[n] * result.values.g[n];
  }
  return result;
}

}  // namespace reference
