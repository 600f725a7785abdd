#include <map_view/InformationTree.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace map_view {

using semantic_octree::Abstraction;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kNone = -1;

/** Below that there is nothing to retain, nats. */
constexpr double kNothing = 1e-12;

}  // namespace

InformationTree::InformationTree(semantic_octree::SemanticOcTree& map)
    : m_numRoots(map.getNumLeafNodes()) {
  const Abstraction abstraction(map);
  m_numTerms = abstraction.options().weights.terms.size();
  const std::size_t nodes = map.size() - map.getNumLeafNodes();
  m_information.reserve(nodes * m_numTerms);
  m_end.reserve(nodes);
  std::array<Index, semantic_octree::kTreeDepth> lastAtDepth{};
  std::array<std::int32_t, semantic_octree::kTreeDepth> chargedAtDepth{};
  int depthBefore = -1;
  const auto endAbove = [&](int depth) {  // subtrees that the next node is not in
    for (int d = depthBefore; d >= depth; --d)
      m_end[std::size_t(lastAtDepth[std::size_t(d)])] = size();
  };
  abstraction.forEachPathNode([&](const Abstraction::PathNode& n, const auto& information) {
    endAbove(n.depth);
    const auto depth = std::size_t(n.depth);
    lastAtDepth[depth] = size(), depthBefore = n.depth;
    chargedAtDepth[depth] = kNone;
    if (!n.isFree) {
      chargedAtDepth[depth] = static_cast<std::int32_t>(m_charged.size());
      m_charged.push_back(size());
      m_parents.push_back(depth == 0 ? kNone : chargedAtDepth[depth - 1]);
      m_prices.push_back(n.price);
      m_numRoots -= std::size_t(n.addedLeaves);
    }
    m_end.push_back(0);
    m_places.push_back(packed(n.lowest, n.depth));
    m_addedLeaves.push_back(n.isFree ? 0 : n.addedLeaves);
    m_information.insert(m_information.end(), information.begin(), information.end());
  });
  endAbove(0);
  m_alphas.assign(m_end.size(), kInfinity);
}

KeyBox InformationTree::box(Index node) const {
  const std::uint64_t place = m_places[std::size_t(node)];
  const auto key = [place](int shift) { return int(place >> shift & 0xffff); };
  const Eigen::Array3i lowest(key(0), key(16), key(32));
  return {lowest, lowest + (semantic_octree::edgeAtDepth(key(48)) - 1)};
}

void InformationTree::setWeights(const std::vector<double>& weights) {
  std::vector<double> gains;
  gains.reserve(m_charged.size());
  for (const Index node : m_charged) {
    const double* const information = &m_information[std::size_t(node) * m_numTerms];
    double gain = 0;
    for (std::size_t t = 0; t < m_numTerms; ++t) gain += weights[t] * information[t];
    gains.push_back(gain);
  }
  const auto alphas = tree_abstraction::collapseAlphas(m_parents, gains, m_prices);
  for (std::size_t i = 0; i < alphas.size(); ++i) m_alphas[std::size_t(m_charged[i])] = alphas[i];
}

std::size_t InformationTree::numLeaves(double alpha) const {
  double leaves = double(m_numRoots);
  for (std::size_t i = 0; i < m_alphas.size(); ++i)
    if (m_alphas[i] > alpha) leaves += m_addedLeaves[i];
  return static_cast<std::size_t>(leaves);
}

double InformationTree::alphaForLeaves(std::size_t wanted) const {
  std::vector<double> alphas, added;
  for (const Index node : m_charged) {
    alphas.push_back(m_alphas[std::size_t(node)]);
    added.push_back(m_addedLeaves[std::size_t(node)]);
  }
  const tree_abstraction::AlphaPath path(std::move(alphas));
  const double budget = double(std::max(wanted, m_numRoots));
  return path.alpha(path.largestWithin(budget, added, double(m_numRoots)));
}

double InformationTree::lowestAlpha(double above) const {
  double lowest = kInfinity;
  for (const double alpha : m_alphas)
    if (alpha > above) lowest = std::min(lowest, alpha);
  return std::isfinite(lowest) ? lowest : above;
}

double InformationTree::highestAlpha() const {
  double highest = 0;
  for (const double alpha : m_alphas)
    if (std::isfinite(alpha)) highest = std::max(highest, alpha);
  return highest;
}

std::vector<std::optional<double>> InformationTree::retained(double alpha) const {
  std::vector<double> all(m_numTerms, 0.0), kept(m_numTerms, 0.0);
  for (std::size_t i = 0; i < m_alphas.size(); ++i) {
    const double* const information = &m_information[i * m_numTerms];
    const bool isExpanded = m_alphas[i] > alpha;
    for (std::size_t t = 0; t < m_numTerms; ++t) {
      all[t] += information[t];
      if (isExpanded) kept[t] += information[t];
    }
  }
  std::vector<std::optional<double>> shares(m_numTerms);
  for (std::size_t t = 0; t < m_numTerms; ++t)
    if (all[t] >= kNothing) shares[t] = kept[t] / all[t];
  return shares;
}

}  // namespace map_view
