#include <semantic_abstraction/AlphaTrees.h>
#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>

#include "CompressedTree.h"

namespace semantic_octree {
namespace {

/** Nodes of trees that are whole, depth first: other trees leave no trace in their taus. */
class WholeTrees {
 public:
  using NodeTau = Abstraction::NodeTau;
  using Visit = std::function<void(const NodeTau&)>;

  WholeTrees(int rootDepth, const Visit& visit) : m_rootDepth(rootDepth), m_visit(visit) {}

  void add(const NodeTau& node, double price) {
    constexpr std::size_t kEnough = 1 << 15;
    const bool isRoot = node.depth == m_rootDepth;
    if (isRoot && m_nodes.size() > kEnough) finish();
    m_lastAtDepth[node.depth] = static_cast<std::int32_t>(m_nodes.size());
    m_parents.push_back(isRoot ? -1 : m_lastAtDepth[node.depth - 1]);
    m_gains.push_back(node.added.relevant - node.added.irrelevant);
    m_prices.push_back(price);
    m_nodes.push_back(node);
  }
  /** Tells what there is, and begins anew. */
  void finish() {
    const auto tau = tree_abstraction::collapseAlphas(m_parents, m_gains, m_prices);
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      m_nodes[i].tau = tau[i];
      m_visit(m_nodes[i]);
    }
    m_nodes.clear(), m_parents.clear(), m_gains.clear(), m_prices.clear();
  }

 private:
  int m_rootDepth;
  const Visit& m_visit;
  std::array<std::int32_t, kTreeDepth> m_lastAtDepth{};
  std::vector<NodeTau> m_nodes;
  std::vector<std::int32_t> m_parents;
  std::vector<double> m_gains, m_prices;
};

}  // namespace

AddedToTree& AddedToTree::operator+=(const AddedToTree& o) {
  leaves += o.leaves;
  relevant += o.relevant;
  irrelevant += o.irrelevant;
  return *this;
}

AddedToTree Abstraction::forEachTau(const std::function<void(const NodeTau&)>& visit) const {
  const auto& terms = options().weights.terms;
  AddedToTree frame;
  WholeTrees trees(rootDepth(), visit);
  forEachPathNode([&](const PathNode& n, const std::vector<double>& information) {
    AddedToTree added{static_cast<double>(n.addedLeaves), 0, 0};
    for (std::size_t t = 0; t < terms.size(); ++t)
      (terms[t].weight > 0 ? added.relevant : added.irrelevant) +=
          std::fabs(terms[t].weight) * information[t];
    if (n.isFree)
      frame += added;
    else
      trees.add({n, n.isExpanded, added, 0}, n.price);
  });
  trees.finish();
  return frame;
}

void Abstraction::forEachPathNode(const VisitPathNode& visit) const {
  const NodeStore& store = MapAccess::store(m_map);
  GTree::Worker& worker = m_gTree.worker(0);
  const double total =
      store.root().isInner() ? store.state<InnerState>(store.root())->density : 1.0;
  std::vector<double> information(options().weights.terms.size());
  std::array<bool, kTreeDepth> inCompressed{};  // of the last inner node at each depth
  const auto tell = [&](const InnerNode& n) {
    const int depth = n.cell.depth;
    inCompressed[depth] = n.isExpanded && (depth == 0 || inCompressed[depth - 1]);
    const double volume = std::ldexp(1.0, -3 * depth),
                 p = total > 0 ? n.density * volume / total : 0;
    for (std::size_t t = 0; t < information.size(); ++t)
      information[t] = p * n.divergences[m_gTree.layout().positionOf(static_cast<int>(t))];
    visit({n.cell, m_gTree.isFreeFrame(depth), inCompressed[depth], p, p * n.splitEntropy,
           n.numChildren - 1},
          information);
  };
  const auto walk = [&](const auto& self, const Slot& slot, const Cube& cell) -> void {
    if (!slot.isInner()) return;
    store.bring(slot);
    worker.inspect(store, slot, cell, tell);
    if (slot.kind == Slot::Kind::Octant)
      for (int i = 0; i < 8; ++i) self(self, store.octant(slot).slots[i], cell.child(i));
  };
  walk(walk, store.root(), Cube());
}

using tree_abstraction::AlphaPath;

namespace {

/** Positive numbers are in the order of their bits. */
std::uint64_t binOf(double tau) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &tau, sizeof(bits));
  return bits >> 43;  // leaves 9 bits behind the point
}

/** The last number for which it is true, as it is for `first`, and not for `end`, by bisection. */
template <typename F>
std::size_t lastThat(const F& f, std::size_t first, std::size_t end) {
  while (end - first > 1) {
    const std::size_t middle = first + (end - first) / 2;
    (f(middle) ? first : end) = middle;
  }
  return first;
}

}  // namespace

AlphaTrees::AlphaTrees(Nodes nodes) : m_nodes(std::move(nodes)) {
  std::map<std::uint64_t, Bin, std::greater<>> bins;
  AddedToTree all;
  const AddedToTree roots = m_nodes([&](double tau, const AddedToTree& added) {
    all += added;
    if (!(tau > 0)) return;
    Bin& bin = bins.try_emplace(binOf(tau), Bin{tau, tau, {}}).first->second;
    bin.highest = std::max(bin.highest, tau);
    bin.lowest = std::min(bin.lowest, tau);
    bin.added += added;
  });
  for (const auto& [number, bin] : bins) m_bins.push_back(bin);
  mergeTies();
  m_trees = {roots};
  for (const Bin& bin : m_bins) m_trees.push_back(AddedToTree(m_trees.back()) += bin.added);
  m_full = roots;
  m_full += all;
}

AlphaTrees::AlphaTrees(const Abstraction& abstraction)
    : AlphaTrees([&abstraction](const Visit& visit) {
        AddedToTree roots =
            abstraction.forEachTau([&](const Abstraction::NodeTau& n) { visit(n.tau, n.added); });
        roots.leaves += 1;  // all trees begin with one
        return roots;
      }) {}

/** Bins that agree but for rounding come in together. */
void AlphaTrees::mergeTies() {
  std::vector<Bin> merged;
  for (const Bin& bin : m_bins) {
    if (merged.empty() || !tree_abstraction::isTie(merged.back().lowest, bin.highest)) {
      merged.push_back(bin);
      continue;
    }
    merged.back().lowest = bin.lowest;
    merged.back().added += bin.added;
  }
  m_bins = std::move(merged);
}

double AlphaTrees::alpha(std::size_t k) const {
  return tree_abstraction::alphaBetween(
      k < m_bins.size() ? m_bins[k].highest : 0.0,
      k > 0 ? m_bins[k - 1].lowest : std::numeric_limits<double>::infinity());
}

AlphaTrees::Path AlphaTrees::within(std::size_t k) const {
  const Bin& bin = m_bins.at(k);
  std::vector<double> taus, leaves;
  if (k > 0) taus.push_back(m_bins[k - 1].lowest);
  if (k + 1 < m_bins.size()) taus.push_back(m_bins[k + 1].highest);
  const std::size_t numOthers = taus.size();
  m_nodes([&](double tau, const AddedToTree& added) {
    if (tau > bin.highest || tau < bin.lowest) return;
    taus.push_back(tau);
    leaves.push_back(added.leaves);
  });
  AlphaPath trees(taus);
  Path path{std::move(trees), k > 0 ? std::size_t(1) : 0, 0, {}};
  path.last = path.trees.numTrees() - (k + 1 < m_bins.size() ? 2 : 1);
  path.addedLeaves.resize(path.trees.numTrees());
  for (std::size_t i = 0; i < leaves.size(); ++i)
    path.addedLeaves[path.trees.treeOf(taus[numOthers + i])] += leaves[i];
  return path;
}

double AlphaTrees::alphaForLeaves(std::size_t wanted) const {
  const auto most = static_cast<double>(wanted);
  if (most < m_trees.front().leaves)
    throw std::invalid_argument(std::to_string(wanted) + " leaves wanted, but the map has " +
                                std::to_string(static_cast<std::size_t>(m_trees.front().leaves)) +
                                " blocks, each of which is a leaf at least (see block_size)");
  if (most > m_full.leaves)
    throw std::invalid_argument(std::to_string(wanted) + " leaves wanted, but the map has only " +
                                std::to_string(static_cast<std::size_t>(m_full.leaves)));
  const std::size_t k =
      lastThat([&](std::size_t i) { return m_trees[i].leaves <= most; }, 0, numTrees());
  if (k + 1 == numTrees()) return alpha(k);
  const Path path = within(k);
  std::size_t tree = path.first;
  double leaves = m_trees[k].leaves;
  while (tree < path.last && (leaves += path.addedLeaves[tree + 1]) <= most) ++tree;
  return path.trees.alpha(tree);
}

double AlphaTrees::largestThat(const std::function<bool(double)>& fits) const {
  const std::size_t k = lastThat([&](std::size_t i) { return fits(alpha(i)); }, 0, numTrees());
  if (k + 1 == numTrees()) return alpha(k);
  const Path path = within(k);
  return path.trees.alpha(
      lastThat([&](std::size_t i) { return fits(path.trees.alpha(i)); }, path.first, path.last));
}

}  // namespace semantic_octree
