#include <stdexcept>

#include "InnerNodes.h"

namespace semantic_octree {
namespace {

/** Nodes below one that has no parent among them: no other tree matters to their taus. */
class TauTree {
 public:
  using NodeTau = Abstraction::NodeTau;

  /** \param node its tau is its gain, for now \return its index, from 0 */
  std::int32_t add(const NodeTau& node, std::int32_t parent, double price) {
    m_nodes.push_back(node);
    m_parents.push_back(parent);
    m_gains.push_back(node.tau);
    m_prices.push_back(price);
    return static_cast<std::int32_t>(m_nodes.size()) - 1;
  }
  /** Tells what there is, and begins anew. */
  void finish(const std::function<void(const NodeTau&)>& visit) {
    if (m_nodes.empty()) return;
    const auto tau = tree_abstraction::collapseAlphas(m_parents, m_gains, m_prices);
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
      m_nodes[i].tau = tau[i];
      visit(m_nodes[i]);
    }
    m_nodes.clear(), m_parents.clear(), m_gains.clear(), m_prices.clear();
  }

 private:
  std::vector<NodeTau> m_nodes;
  std::vector<std::int32_t> m_parents;
  std::vector<double> m_gains, m_prices;
};

}  // namespace

void Abstraction::forEachTau(const std::function<void(const NodeTau&)>& visit) const {
  const double total = totalDensity();
  TauTree tree;
  std::array<std::int32_t, kTreeDepth> lastAtDepth;  // node visited last; -1: of the free frame
  InCompressedTree inCompressed;
  forEachInner([&](const InnerNode& n) {
    const bool isExpanded = inCompressed.visit(n);
    std::int32_t& index = lastAtDepth[n.cell.depth] = -1;
    if (m_gTree.isFreeFrame(n.cell.depth)) return;
    const std::int32_t parent = n.cell.depth == 0 ? -1 : lastAtDepth[n.cell.depth - 1];
    if (parent < 0) tree.finish(visit);
    const double p = total > 0 ? n.density * volumeOf(n.cell) / total : 0.0;
    index = tree.add(
        {n.cell.lowest(), n.cell.depth, n.numChildren - 1, isExpanded, p * n.weightedDivergence},
        parent, p * n.splitEntropy);
  });
  tree.finish(visit);
}

Abstraction::Path Abstraction::alphaPath() const {
  std::vector<double> tau, addedLeaves;
  std::size_t numRoots = m_map.getNumLeafNodes();
  forEachTau([&](const NodeTau& n) {
    tau.push_back(n.tau);
    addedLeaves.push_back(n.addedLeaves);
    numRoots -= static_cast<std::size_t>(n.addedLeaves);
  });
  return {tree_abstraction::AlphaPath(std::move(tau)), std::move(addedLeaves), numRoots};
}

Abstraction::PathInformation Abstraction::pathInformation(
    const std::vector<double>& termWeights) const {
  const std::size_t numTerms = options().weights.terms.size();
  if (termWeights.size() != numTerms)
    throw std::invalid_argument(
        "information along the path: " + std::to_string(termWeights.size()) +
        " weights, expected one for each of the " + std::to_string(numTerms) + " terms");
  PathInformation information;
  const double total = totalDensity();
  forEachInner([&](const InnerNode& n) {
    double gain = 0;
    for (std::size_t t = 0; t < numTerms; ++t)
      gain += termWeights[t] * n.divergences[m_gTree.layout().positionOf(static_cast<int>(t))];
    gain *= total > 0 ? n.density * volumeOf(n.cell) / total : 0.0;
    if (m_gTree.isFreeFrame(n.cell.depth))
      information.ofRoots += gain;
    else
      information.added.push_back(gain);
  });
  return information;
}

void Abstraction::forEachPathNode(const VisitPathNode& visit) const {
  std::vector<double> information(options().weights.terms.size());
  const double total = totalDensity();
  forEachInner([&](const InnerNode& n) {
    const double p = total > 0 ? n.density * volumeOf(n.cell) / total : 0.0;
    for (std::size_t t = 0; t < information.size(); ++t)
      information[t] = p * n.divergences[m_gTree.layout().positionOf(static_cast<int>(t))];
    visit({n.cell.lowest(), n.cell.depth, m_gTree.isFreeFrame(n.cell.depth), p, p * n.splitEntropy,
           n.numChildren - 1},
          information);
  });
}

double Abstraction::Path::alphaForLeaves(std::size_t wanted) const {
  return trees.alpha(trees.largestWithLeaves(wanted, addedLeaves, numRoots));
}

}  // namespace semantic_octree
