#include "AlphaBins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <map>

namespace semantic_map_compress {

using semantic_octree::Abstraction;
using tree_abstraction::AlphaPath;

namespace {

/** The nodes of some of the trees' roots, with all that is below them: others leave no trace in
 * their taus. */
class Batch {
 public:
  using Visit = std::function<void(double tau, const Added& added)>;

  Batch(const Abstraction& abstraction, const Visit& visit)
      : m_rootDepth(abstraction.rootDepth()), m_visit(visit) {
    for (const auto& term : abstraction.options().weights.terms) m_weights.push_back(term.weight);
  }

  Added addedBy(const Abstraction::PathNode& node, const std::vector<double>& information) const {
    Added added{static_cast<double>(node.addedLeaves), 0, 0};
    for (std::size_t t = 0; t < m_weights.size(); ++t)
      (m_weights[t] > 0 ? added.relevant : added.irrelevant) +=
          std::fabs(m_weights[t]) * information[t];
    return added;
  }

  /** A node's subtree follows it. */
  void add(const Abstraction::PathNode& node, const Added& added) {
    constexpr std::size_t kEnough = 1 << 18;
    const bool isRoot = node.depth == m_rootDepth;
    if (isRoot && m_parents.size() > kEnough) finish();
    m_lastAtDepth[node.depth] = static_cast<std::int32_t>(m_parents.size());
    m_parents.push_back(isRoot ? -1 : m_lastAtDepth[node.depth - 1]);
    m_gains.push_back(added.relevant - added.irrelevant);
    m_prices.push_back(node.price);
    m_added.push_back(added);
  }

  void finish() {
    const auto taus = tree_abstraction::collapseAlphas(m_parents, m_gains, m_prices);
    for (std::size_t i = 0; i < taus.size(); ++i) m_visit(taus[i], m_added[i]);
    m_parents.clear();
    m_gains.clear();
    m_prices.clear();
    m_added.clear();
  }

 private:
  int m_rootDepth;
  const Visit& m_visit;
  std::vector<double> m_weights;
  std::array<std::int32_t, semantic_octree::kTreeDepth> m_lastAtDepth{};
  std::vector<std::int32_t> m_parents;
  std::vector<double> m_gains, m_prices;
  std::vector<Added> m_added;
};

/** Calls visit(tau, added) for the nodes of all trees' roots, and all below. \return what the free
 * frame above them adds */
Added forEachTau(const Abstraction& abstraction, const Batch::Visit& visit) {
  Added frame;
  Batch batch(abstraction, visit);
  abstraction.forEachPathNode([&](const auto& node, const auto& information) {
    const Added added = batch.addedBy(node, information);
    node.isFree ? void(frame += added) : batch.add(node, added);
  });
  batch.finish();
  return frame;
}

/** Positive numbers are in the order of their bits. */
std::uint64_t binOf(double tau) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &tau, sizeof(bits));
  return bits >> 43;  // leaves 9 bits behind the point
}

bool isTie(double larger, double smaller) {
  constexpr double kTolerance = 1e-12;  // AlphaPath's
  return larger == smaller || larger - smaller <= kTolerance * smaller;
}

}  // namespace

Added& Added::operator+=(const Added& o) {
  leaves += o.leaves;
  relevant += o.relevant;
  irrelevant += o.irrelevant;
  return *this;
}

AlphaBins::AlphaBins(const Abstraction& abstraction) : m_abstraction(abstraction) {
  std::map<std::uint64_t, Bin, std::greater<>> bins;
  Added all;
  Added roots = forEachTau(abstraction, [&](double tau, const Added& added) {
    all += added;
    if (!(tau > 0)) return;
    Bin& bin = bins.try_emplace(binOf(tau), Bin{tau, tau, {}}).first->second;
    bin.highest = std::max(bin.highest, tau);
    bin.lowest = std::min(bin.lowest, tau);
    bin.added += added;
  });
  roots.leaves += 1;  // all trees begin with one
  for (const auto& [number, bin] : bins) m_bins.push_back(bin);
  mergeTies();
  m_trees = {roots};
  for (const Bin& bin : m_bins) m_trees.push_back(Added(m_trees.back()) += bin.added);
  m_full = roots;
  m_full += all;
}

/** Those that agree but for rounding come in together. */
void AlphaBins::mergeTies() {
  std::vector<Bin> merged;
  for (const Bin& bin : m_bins) {
    if (merged.empty() || !isTie(merged.back().lowest, bin.highest)) {
      merged.push_back(bin);
      continue;
    }
    merged.back().lowest = bin.lowest;
    merged.back().added += bin.added;
  }
  m_bins = std::move(merged);
}

double AlphaBins::alpha(std::size_t k) const {
  std::vector<double> taus;
  if (k > 0) taus.push_back(m_bins[k - 1].lowest);
  if (k < m_bins.size()) taus.push_back(m_bins[k].highest);
  return AlphaPath(std::move(taus)).alpha(k > 0 ? 1 : 0);
}

AlphaBins::Path AlphaBins::within(std::size_t k) const {
  const Bin& bin = m_bins.at(k);
  std::vector<double> taus, leaves;
  const auto add = [&](double tau, double addedLeaves) {
    taus.push_back(tau);
    leaves.push_back(addedLeaves);
  };
  if (k > 0) add(m_bins[k - 1].lowest, 0);
  if (k + 1 < m_bins.size()) add(m_bins[k + 1].highest, 0);
  forEachTau(m_abstraction, [&](double tau, const Added& added) {
    if (tau <= bin.highest && tau >= bin.lowest) add(tau, added.leaves);
  });
  AlphaPath path(std::move(taus));
  const std::size_t last = path.numTrees() - (k + 1 < m_bins.size() ? 2 : 1);
  return {std::move(path), k > 0 ? std::size_t(1) : 0, last, std::move(leaves)};
}

}  // namespace semantic_map_compress
