#include <map_view/LiveCompression.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace map_view {

using semantic_octree::Abstraction;
using semantic_octree::AlphaTrees;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kNone = -1;

/** Below that there is nothing to retain, nats. */
constexpr double kNothing = 1e-12;

/** A cube in one number. */
std::uint64_t packed(const Cube& cube) {
  return std::uint64_t(cube.lowest.x()) | std::uint64_t(cube.lowest.y()) << 16 |
         std::uint64_t(cube.lowest.z()) << 32 | std::uint64_t(cube.depth) << 48;
}

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
      m_shares.push_back(n.share);
      m_prices.push_back(n.price);
      m_numRoots -= std::size_t(n.addedLeaves);
    }
    m_end.push_back(0);
    m_places.push_back(packed(n));
    m_addedLeaves.push_back(n.isFree ? 0 : n.addedLeaves);
    m_information.insert(m_information.end(), information.begin(), information.end());
  });
  endAbove(0);
  m_alphas.assign(m_end.size(), kInfinity);
}

Cube InformationTree::cube(Index node) const {
  const std::uint64_t place = m_places[std::size_t(node)];
  const auto key = [place](int shift) { return int(place >> shift & 0xffff); };
  return {{key(0), key(16), key(32)}, key(48)};
}

void InformationTree::setWeights(const std::vector<double>& weights) {
  m_weights = weights;
  m_gains.clear();
  for (const Index node : m_charged) {
    double gain = 0;
    for (std::size_t t = 0; t < m_numTerms; ++t) gain += weights[t] * information(node, t);
    m_gains.push_back(gain);
  }
  const auto alphas = tree_abstraction::collapseAlphas(m_parents, m_gains, m_prices);
  for (std::size_t i = 0; i < alphas.size(); ++i) m_alphas[std::size_t(m_charged[i])] = alphas[i];
}

std::size_t InformationTree::numLeaves(double alpha) const {
  double leaves = double(m_numRoots);
  for (std::size_t i = 0; i < m_alphas.size(); ++i)
    if (m_alphas[i] > alpha) leaves += m_addedLeaves[i];
  return static_cast<std::size_t>(leaves);
}

AlphaTrees InformationTree::trees() const {
  return AlphaTrees([this](const AlphaTrees::Visit& visit) -> semantic_octree::AddedToTree {
    for (const Index node : m_charged) visit(alpha(node), {m_addedLeaves[std::size_t(node)], 0, 0});
    return {double(m_numRoots), 0, 0};
  });
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
  for (Index node = 0; node < size(); ++node) {
    const bool isExpanded = this->alpha(node) > alpha;
    for (std::size_t t = 0; t < m_numTerms; ++t) {
      all[t] += information(node, t);
      if (isExpanded) kept[t] += information(node, t);
    }
  }
  std::vector<std::optional<double>> shares(m_numTerms);
  for (std::size_t t = 0; t < m_numTerms; ++t)
    if (all[t] >= kNothing) shares[t] = kept[t] / all[t];
  return shares;
}

std::vector<float> InformationTree::retainedInBlocks(double alpha) const {
  std::vector<float> shares(m_end.size(), 1.f);
  for (std::size_t i = 0; i < m_charged.size();) {
    const Index block = m_charged[i], end = this->end(block);
    double all = 0, kept = 0;
    for (; i < m_charged.size() && m_charged[i] < end; ++i) {
      double relevant = 0;
      for (std::size_t t = 0; t < m_numTerms; ++t)
        relevant += std::max(0.0, m_weights[t]) * information(m_charged[i], t);
      all += relevant;
      if (this->alpha(m_charged[i]) > alpha) kept += relevant;
    }
    if (all >= kNothing) std::fill(shares.begin() + block, shares.begin() + end, float(kept / all));
  }
  return shares;
}

std::vector<std::size_t> InformationTree::chargedAround(const Eigen::Array3i& key) const {
  std::vector<std::size_t> found;
  for (Index node = 0, end = size(); node < end;) {
    if (!cube(node).contains(key)) {
      node = m_end[std::size_t(node)];  // over its subtree
      continue;
    }
    const auto place = std::lower_bound(m_charged.begin(), m_charged.end(), node);
    if (place != m_charged.end() && *place == node)
      found.push_back(std::size_t(place - m_charged.begin()));
    end = m_end[std::size_t(node)];
    ++node;
  }
  return found;
}

std::vector<InformationTree::Balance> InformationTree::balancesAround(const Eigen::Array3i& key,
                                                                      double alpha) const {
  const std::vector<std::size_t> around = chargedAround(key);
  if (around.empty()) return {};
  // What the children's G-values sum up to, times p(n), for the largest node and all below it,
  // children before parents.
  const std::size_t first = around.front();
  const auto end =
      std::lower_bound(m_charged.begin(), m_charged.end(), m_end[std::size_t(m_charged[first])]);
  std::vector<double> ofChildren(std::size_t(end - m_charged.begin()) - first, 0.0);
  const auto valueOf = [&](std::size_t i) {
    return std::max(0.0, m_gains[i] - alpha * m_prices[i] + ofChildren[i - first]);
  };
  for (std::size_t i = first + ofChildren.size() - 1; i > first; --i)
    ofChildren[std::size_t(m_parents[i]) - first] += valueOf(i);

  std::vector<Balance> balances;
  for (const std::size_t i : around) {
    const double unit = m_shares[i] > 0 ? 1 / m_shares[i] : 0;
    Balance balance = {
        m_charged[i],     {}, unit * m_gains[i], unit * m_prices[i], unit * ofChildren[i - first],
        unit * valueOf(i)};
    for (std::size_t t = 0; t < m_numTerms; ++t)
      balance.divergences.push_back(unit * information(m_charged[i], t));
    balances.push_back(std::move(balance));
  }
  return balances;
}

}  // namespace map_view
