#include <tree_abstraction/AlphaPath.h>

#include "InnerNodes.h"

namespace semantic_octree {
namespace {

/** Nodes of trees that are whole, depth first: other trees leave no trace in their taus. */
class WholeTrees {
 public:
  using NodeTau = Abstraction::NodeTau;
  using Visit = std::function<void(const NodeTau&)>;

  WholeTrees(int rootDepth, const Visit& visit) : m_rootDepth(rootDepth), m_visit(visit) {}

  void add(const NodeTau& node, double price) {
    constexpr std::size_t kEnough = 1 << 18;
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
  std::vector<double> information(options().weights.terms.size());
  const double total = totalDensity();
  InCompressedTree inCompressed;
  forEachInner([&](const InnerNode& n) {
    const double p = shareOf(n, total);
    for (std::size_t t = 0; t < information.size(); ++t)
      information[t] = p * n.divergences[m_gTree.layout().positionOf(static_cast<int>(t))];
    visit({n.cell.cube(), m_gTree.isFreeFrame(n.cell.depth), inCompressed.visit(n), p,
           p * n.splitEntropy, n.numChildren - 1},
          information);
  });
}

}  // namespace semantic_octree
