#include "GTreeSearch.h"

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace reference {

using tree_abstraction::AbstractionWeights;
using tree_abstraction::InformationTerm;
using tree_abstraction::TreeMeasures;
using Numbers = std::vector<std::int32_t>;  // of nodes

namespace {

double entropy(const std::vector<double>& p) {
  return tree_abstraction::entropy(p.data(), p.size());
}

/** Probabilities of a term's outcomes: its groups, and the rest. */
std::vector<double> outcomesOf(const std::vector<double>& classes, const InformationTerm& term) {
  std::vector<double> outcomes, rest = classes;
  for (const std::vector<int>& group : term.groups) {
    double sum = 0;
    for (const int id : group) sum += std::exchange(rest[static_cast<std::size_t>(id)], 0);
    outcomes.push_back(sum);
  }
  outcomes.push_back(std::accumulate(rest.begin(), rest.end(), 0.0));
  return outcomes;
}

/** Pi: each node's share of the weight of all; even shares if none has any. */
std::vector<double> sharesOf(const Forest& forest, const Numbers& family) {
  double sum = 0;
  for (const auto n : family) sum += forest[n].weight;
  std::vector<double> shares;
  for (const auto n : family)
    shares.push_back(sum > 0 ? forest[n].weight / sum : 1.0 / static_cast<double>(family.size()));
  return shares;
}

/** q = sum_i Pi_i p_i */
std::vector<double> mixtureOf(const Forest& forest, const Numbers& family) {
  const std::vector<double> shares = sharesOf(forest, family);
  std::vector<double> mixture(forest[family.front()].distribution.size());
  for (std::size_t i = 0; i < family.size(); ++i)
    for (std::size_t k = 0; k < mixture.size(); ++k)
      mixture[k] += shares[i] * forest[family[i]].distribution[k];
  return mixture;
}

/** JS_t = H(q) - sum_i Pi_i H(p_i), of the outcomes of each term. */
std::vector<double> divergencesOf(const Forest& forest, const Numbers& family,
                                  const AbstractionWeights& weights) {
  const std::vector<double> shares = sharesOf(forest, family), mixture = mixtureOf(forest, family);
  std::vector<double> divergences;
  for (const InformationTerm& term : weights.terms) {
    double js = entropy(outcomesOf(mixture, term));
    for (std::size_t i = 0; i < family.size(); ++i)
      js -= shares[i] * entropy(outcomesOf(forest[family[i]].distribution, term));
    divergences.push_back(js);
  }
  return divergences;
}

/** Weights and distributions of the inner nodes from their children's, deepest first. */
void fillInnerNodes(Forest& forest) {
  for (std::size_t n = forest.size(); n-- > 0;) {
    Forest::Node& node = forest.nodes[n];
    if (node.children.empty()) continue;
    for (const auto child : node.children) {
      node.weight += forest[child].weight;
      node.known |= forest[child].known;
    }
    node.distribution = mixtureOf(forest, node.children);
  }
}

double gainOf(const NodeValues& values, const AbstractionWeights& weights) {
  double gain = 0;
  for (std::size_t t = 0; t < weights.terms.size(); ++t)
    gain += weights.terms[t].weight * values.divergence[t];
  return gain;
}

/** V(n) = dJ(n) + sum_c Pi_c G(c) */
double valueOf(const SearchResult& found, std::size_t n, const AbstractionWeights& weights) {
  const Numbers& children = found.forest.nodes[n].children;
  const std::vector<double> shares = sharesOf(found.forest, children);
  double v = gainOf(found.values[n], weights) - weights.alpha * found.values[n].splitEntropy;
  for (std::size_t i = 0; i < children.size(); ++i)
    v += shares[i] * found.values[static_cast<std::size_t>(children[i])].g;
  return v;
}

/** The pass from the deepest nodes up. */
void computeValues(SearchResult& found, const AbstractionWeights& weights) {
  double total = 0;
  for (const auto root : found.forest.roots) total += found.forest[root].weight;
  found.values.resize(found.forest.size());
  for (std::size_t n = found.values.size(); n-- > 0;) {
    const Forest::Node& node = found.forest.nodes[n];
    NodeValues& values = found.values[n];
    values.probability = node.weight / total;
    values.divergence.assign(weights.terms.size(), 0.0);
    if (node.children.empty() || !(node.weight > 0)) continue;
    values.splitEntropy = entropy(sharesOf(found.forest, node.children));
    values.divergence = divergencesOf(found.forest, node.children, weights);
    values.v = valueOf(found, n, weights);
    values.g = std::max(0.0, values.v);
  }
}

/** The pass from the roots down. */
void expand(SearchResult& found, double eps) {
  for (std::size_t n = 0; n < found.values.size(); ++n) {
    const std::int32_t parent = found.forest.nodes[n].parent;
    NodeValues& values = found.values[n];
    values.reached =
        parent == Forest::kNoParent || found.values[static_cast<std::size_t>(parent)].expanded;
    values.expanded = values.reached && values.g > eps;
  }
}

}  // namespace

std::int32_t Forest::add(Node node) {
  const auto number = static_cast<std::int32_t>(nodes.size());
  (node.parent == kNoParent ? roots : nodes[static_cast<std::size_t>(node.parent)].children)
      .push_back(number);
  nodes.push_back(std::move(node));
  return number;
}

SearchResult findOptimalTree(Forest forest, const AbstractionWeights& weights) {
  fillInnerNodes(forest);
  weights.validate(static_cast<int>(forest[forest.roots.front()].distribution.size()) - 1);
  SearchResult found{std::move(forest), {}, 0, {}, {}, {}};
  computeValues(found, weights);
  expand(found, weights.eps());

  for (const auto root : found.forest.roots) {
    const NodeValues& values = found.values[static_cast<std::size_t>(root)];
    found.objective += values.probability * values.g;
  }
  std::vector<char> all;
  for (const Forest::Node& node : found.forest.nodes) all.push_back(!node.children.empty());
  found.roots = measuresOf(found, weights, std::vector<char>(all.size(), false));
  found.optimal = measuresOf(found, weights, found.expanded());
  found.full = measuresOf(found, weights, all);
  return found;
}

TreeMeasures measuresOf(const SearchResult& found, const AbstractionWeights& weights,
                        const std::vector<char>& expanded) {
  TreeMeasures measures;
  measures.leafEntropy = entropy(sharesOf(found.forest, found.forest.roots));
  measures.information = divergencesOf(found.forest, found.forest.roots, weights);
  for (std::size_t n = 0; n < expanded.size(); ++n) {
    const Forest::Node& node = found.forest.nodes[n];
    const NodeValues& values = found.values[n];
    const bool reached =
        node.parent == Forest::kNoParent || expanded[static_cast<std::size_t>(node.parent)];
    if (!reached) continue;
    if (!expanded[n]) {
      ++measures.numLeaves;
      measures.numKnownLeaves += node.known;
      continue;
    }
    measures.leafEntropy += values.probability * values.splitEntropy;
    for (std::size_t t = 0; t < weights.terms.size(); ++t)
      measures.information[t] += values.probability * values.divergence[t];
  }
  return measures;
}

Numbers SearchResult::interior() const {
  Numbers nodes;
  for (std::size_t n = 0; n < values.size(); ++n)
    if (values[n].expanded) nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

Numbers SearchResult::leaves() const {
  Numbers nodes;
  for (std::size_t n = 0; n < values.size(); ++n)
    if (values[n].reached && !values[n].expanded) nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

std::vector<char> SearchResult::expanded() const {
  std::vector<char> mask;
  for (const NodeValues& node : values) mask.push_back(node.expanded);
  return mask;
}

Numbers SearchResult::parents() const {
  Numbers parents;
  for (const Forest::Node& node : forest.nodes) parents.push_back(node.parent);
  return parents;
}

std::vector<double> SearchResult::gains(const AbstractionWeights& weights) const {
  std::vector<double> gains;
  for (const NodeValues& node : values) gains.push_back(node.probability * gainOf(node, weights));
  return gains;
}

std::vector<double> SearchResult::prices() const {
  std::vector<double> prices;
  for (const NodeValues& node : values) prices.push_back(node.probability * node.splitEntropy);
  return prices;
}

}  // namespace reference
