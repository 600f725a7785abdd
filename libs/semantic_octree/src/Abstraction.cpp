#include <semantic_octree/Abstraction.h>
#include <tree_abstraction/AlphaPath.h>

#include <cmath>
#include <stdexcept>

#include "CompressedTree.h"
#include "LeafContent.h"

namespace semantic_octree {
namespace {

GTree& gTreeOf(GTree* gTree) {
  if (!gTree) throw std::logic_error("the map keeps no G-values: call setAbstraction() first");
  return *gTree;
}

/** p(n) of a node per unit of density: its share of the whole map's volume. */
double volumeOf(const Cell& cell) { return std::ldexp(1.0, -3 * cell.depth); }

/** Calls f(node, cell) for all inner nodes, parents first. */
template <typename F>
void forEachInner(const Node& node, const Cell& cell, const F& f) {
  if (node.isLeaf()) return;
  f(node, cell);
  for (int i = 0; i < 8; ++i)
    if (const Node* child = node.child(i)) forEachInner(*child, cell.child(i), f);
}

int numChildren(const Node& inner) {
  int n = 0;
  for (int i = 0; i < 8; ++i) n += inner.child(i) != nullptr;
  return n;
}

double knownVolume(const Node& node) {
  if (node.isLeaf()) return 1;
  double sum = 0;
  for (int i = 0; i < 8; ++i)
    if (const Node* child = node.child(i)) sum += knownVolume(*child);
  return sum / 8;
}

}  // namespace

std::optional<double> AbstractionMeasures::retention(std::size_t term) const {
  if (full.information[term] < 1e-12) return std::nullopt;
  return compressed.information[term] / full.information[term];
}

Abstraction::Abstraction(SemanticOcTree& map) : m_map(map), m_gTree(gTreeOf(map.m_gTree.get())) {}

CompressedTree Abstraction::compressedTree() const { return {*m_map.m_store, m_gTree}; }

const AbstractionOptions& Abstraction::options() const { return m_gTree.options(); }

std::vector<LeafCell> Abstraction::leaves() const {
  std::vector<LeafCell> leaves;
  if (m_map.empty()) return leaves;
  compressedTree().forEachLeaf(*m_map.root(), Cell(), [&](const Node& node, const Cell& cell) {
    leaves.push_back(leafCell(&node, cell));
  });
  return leaves;
}

std::vector<LeafCell> Abstraction::leavesIn(const octomap::OcTreeKey& low,
                                            const octomap::OcTreeKey& high,
                                            bool onlyOccupied) const {
  std::vector<LeafCell> leaves;
  if (m_map.empty()) return leaves;
  const VoxelIndex first(low[0], low[1], low[2]), last(high[0], high[1], high[2]);
  const auto isWanted = [&](const Node& node, const Cell& cell) {
    const VoxelIndex lowest = cell.lowest();
    return (!onlyOccupied || node.getLogOdds() > 0) && (lowest <= last).all() &&
           (lowest + cell.edge() > first).all();
  };
  compressedTree().forEachLeaf(
      *m_map.root(), Cell(), isWanted,
      [&](const Node& node, const Cell& cell) { leaves.push_back(leafCell(&node, cell)); });
  return leaves;
}

double Abstraction::objective() const {
  return m_map.empty() || m_map.root()->isLeaf() ? 0.0
                                                 : compressedTree().state(*m_map.root()).gValue;
}

AbstractionMeasures Abstraction::measures() const {
  AbstractionMeasures m;
  const std::size_t numTerms = options().weights.terms.size();
  m.full.information.assign(numTerms, 0.0);
  m.compressed.information.assign(numTerms, 0.0);
  if (m_map.empty()) return m;
  m.objective = objective();
  for (auto* tree : {&m.full, &m.compressed}) tree->numLeaves = tree->numKnownLeaves = 1;
  if (m_map.root()->isLeaf()) return m;
  const CompressedTree walk = compressedTree();
  const double total = walk.state(*m_map.root()).density;
  const auto count = [&](tree_abstraction::TreeMeasures& tree, const Node& node, const Cell& cell,
                         double p) {
    const InnerState& s = walk.state(node);
    const double* js = m_gTree.divergences(s);
    tree.leafEntropy += p * s.splitEntropy;
    for (std::size_t t = 0; t < numTerms; ++t)
      tree.information[t] += p * js[m_gTree.layout().positionOf(static_cast<int>(t))];
    tree.numKnownLeaves += numChildren(node) - 1;
    tree.numLeaves += (cell.depth < m_gTree.blockDepth() ? numChildren(node) : 8) - 1;
  };
  const auto visit = [&](const auto& self, const Node& node, const Cell& cell,
                         bool inCompressed) -> void {
    if (node.isLeaf()) return;
    const double p = total > 0 ? walk.state(node).density * volumeOf(cell) / total : 0.0;
    count(m.full, node, cell, p);
    inCompressed = inCompressed && walk.state(node).isExpanded;
    if (inCompressed) count(m.compressed, node, cell, p);
    for (int i = 0; i < 8; ++i)
      if (const Node* child = node.child(i)) self(self, *child, cell.child(i), inCompressed);
  };
  visit(visit, *m_map.root(), Cell(), true);
  return m;
}

std::vector<double> Abstraction::distribution(const LeafCell& leaf) const {
  return m_map.distribution(*leaf.node);
}

double Abstraction::knownShare(const LeafCell& leaf) const { return knownVolume(*leaf.node); }

SemanticOcTree Abstraction::compressedMap() const {
  SemanticOcTree compressed(m_map.getResolution(), m_map.classes(), m_map.filterParameters());
  if (m_map.empty()) return compressed;
  NodeStore& store = *compressed.m_store;
  NodeArena& arena = store.arena(0);
  const CompressedTree tree = compressedTree();
  const auto copy = [&](const auto& self, const Node& from, Node& to) -> void {
    if (!tree.isExpanded(from)) return contentOf(m_map, from).write(arena, to);
    to.setValue(from.getValue());
    Octant& octant = arena.createOctant(to);
    for (int i = 0; i < 8; ++i)
      if (const Node* child = from.child(i)) self(self, *child, arena.createChild(octant, i));
  };
  copy(copy, *m_map.root(), store.root());
  compressed.attachRoot();
  return compressed;
}

TreeChange Abstraction::takeChange() {
  if (m_map.empty()) return m_map.m_leafChanges->clear(*m_map.m_store, m_gTree);
  return m_map.m_leafChanges->update(*m_map.m_store, m_gTree, *m_map.root());
}

void Abstraction::setAlpha(double alpha) {
  std::vector<double> weights;
  for (const auto& term : options().weights.terms) weights.push_back(term.weight);
  setWeights(weights, alpha);
}

void Abstraction::setWeights(const std::vector<double>& termWeights, double alpha) {
  tree_abstraction::AbstractionWeights weights = options().weights;
  if (termWeights.size() != weights.terms.size())
    throw std::invalid_argument("abstraction: " + std::to_string(termWeights.size()) +
                                " weights, expected one for each of the " +
                                std::to_string(weights.terms.size()) + " terms");
  for (std::size_t t = 0; t < termWeights.size(); ++t) weights.terms[t].weight = termWeights[t];
  weights.alpha = alpha;
  weights.validate(m_map.numClasses());
  m_gTree.setWeights(termWeights, alpha);
  if (!m_map.empty() && !m_map.root()->isLeaf())
    m_gTree.worker(0).reweigh(*m_map.m_store, m_map.m_store->root(), Cell());
}

void Abstraction::setRegions(const std::vector<Region>& regions) {
  for (const Region& region : regions) region.validate();
  const DensityField before = m_gTree.density();
  m_gTree.setRegions(regions, m_map.getResolution());
  if (!m_map.empty())
    m_gTree.worker(0).recomputeWhereChanged(*m_map.m_store, m_map.m_store->root(), Cell(), before);
}

Abstraction::Path Abstraction::alphaPath() const {
  std::vector<std::int32_t> parents;
  std::vector<double> gains, prices, addedLeaves;
  std::size_t numRoots = 0;
  const CompressedTree walk = compressedTree();
  const double total =
      m_map.empty() || m_map.root()->isLeaf() ? 1 : walk.state(*m_map.root()).density;
  const auto visit = [&](const auto& self, const Node& node, const Cell& cell,
                         std::int32_t parent) -> void {
    if (parent < 0 && (node.isLeaf() || !m_gTree.isFreeFrame(cell.depth))) ++numRoots;
    if (node.isLeaf()) return;
    std::int32_t index = parent;
    if (!m_gTree.isFreeFrame(cell.depth)) {
      const InnerState& s = walk.state(node);
      const double p = total > 0 ? s.density * volumeOf(cell) / total : 0.0;
      index = static_cast<std::int32_t>(parents.size());
      parents.push_back(parent);
      gains.push_back(p * m_gTree.weightedDivergence(s));
      prices.push_back(p * s.splitEntropy);
      addedLeaves.push_back(numChildren(node) - 1);
    }
    for (int i = 0; i < 8; ++i)
      if (const Node* child = node.child(i)) self(self, *child, cell.child(i), index);
  };
  if (!m_map.empty()) visit(visit, *m_map.root(), Cell(), -1);
  return {tree_abstraction::AlphaPath(tree_abstraction::collapseAlphas(parents, gains, prices)),
          std::move(addedLeaves), numRoots};
}

double Abstraction::Path::alphaForLeaves(std::size_t wanted) const {
  return trees.alpha(trees.largestWithLeaves(wanted, addedLeaves, numRoots));
}

}  // namespace semantic_octree
