#include "GTree.h"

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>

namespace semantic_octree {
namespace {

constexpr double kLogEight = 3 * tree_abstraction::kLn2;

/** Depth of the largest nodes whose edge does not exceed this many meters; 0 without blocks. */
int depthOfBlocks(double blockSize, double resolution) {
  if (blockSize <= 0) return 0;
  int depth = kTreeDepth;
  while (depth > 0 &&
         resolution * std::ldexp(1.0, kTreeDepth - depth + 1) <= blockSize * (1 + 1e-9))
    --depth;
  return depth;
}

double sumOfEight(const double* x) {
  return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

/** Shares Pi of eight children. \return whether all are 1/8 */
bool sharesOf(const double* densities, double* shares) {
  bool equal = true;
  for (int i = 1; i < 8; ++i) equal &= densities[i] == densities[0];
  const double total = sumOfEight(densities);
  for (int i = 0; i < 8; ++i) shares[i] = equal ? 0.125 : densities[i] / total;
  return equal;
}

double weightedSumOfEight(const double* shares, const double* x) {
  double products[8];
  for (int i = 0; i < 8; ++i) products[i] = shares[i] * x[i];
  return sumOfEight(products);
}

double entropyOfShares(const double* shares) {
  double terms[8];
  for (int i = 0; i < 8; ++i) terms[i] = tree_abstraction::xLogX(shares[i]);
  return 0.0 - sumOfEight(terms);
}

}  // namespace

GTree::GTree(const AbstractionOptions& options, const ClassFilter<float>& filter, double resolution)
    : m_options(options),
      m_layout(options, filter.numClasses()),
      m_filter(filter),
      m_blockDepth(depthOfBlocks(options.blockSize, resolution)),
      m_density(options.regions, resolution) {
  std::vector<double> termWeights;
  for (const auto& term : options.weights.terms) termWeights.push_back(term.weight);
  setWeights(termWeights, options.weights.alpha);
}

std::size_t GTree::stateBytes() const {
  return sizeof(InnerState) + (m_layout.rowSize() + m_layout.sizes().terms) * sizeof(double);
}

void GTree::setWeights(const std::vector<double>& termWeights, double alpha) {
  m_weights.assign(m_layout.sizes().terms, 0.0);
  for (std::size_t t = 0; t < termWeights.size(); ++t) {
    m_options.weights.terms[t].weight = termWeights[t];
    m_weights[m_layout.positionOf(static_cast<int>(t))] = termWeights[t];
  }
  m_options.weights.alpha = alpha;
  m_eps = m_options.weights.eps();
}

void GTree::setRegions(std::vector<Region> regions, double resolution) {
  m_options.regions = regions;
  m_density = DensityField(std::move(regions), resolution);
}

GTree::Worker& GTree::worker(int i) {
  while (static_cast<int>(m_workers.size()) <= i) m_workers.emplace_back(*this);
  return m_workers[i];
}

double GTree::weightedDivergence(const InnerState& s) const {
  const double* js = divergences(s);
  double sum = 0;
  for (std::size_t t = 0; t < m_weights.size(); ++t) sum += m_weights[t] * js[t];
  return sum;
}

void GTree::settleG(InnerState& s, int depth, double childrensG) const {
  const std::uint8_t before = s.isExpanded;
  if (isFreeFrame(depth)) {
    s.gValue = childrensG;
    s.isExpanded = 1;
  } else {
    const double v = childrensG - m_options.weights.alpha * s.splitEntropy + weightedDivergence(s);
    s.gValue = std::max(v, 0.0);
    s.isExpanded = v > m_eps;
  }
  s.changedBelow |= s.isExpanded != before;
}

GTree::Worker::Worker(const GTree& gTree)
    : m_gTree(gTree),
      m_uniformRows(gTree.layout().rowSize()),
      m_recordRows(gTree.layout().rowSize()) {}

const double* GTree::Worker::rowOf(const NodeStore& store, const Node& leaf) {
  const RowLayout& layout = m_gTree.layout();
  if (leaf.hasClassRecord())
    return m_recordRows.row(store.record(leaf),
                            [&](const Belief& b, double* row) { layout.rowOf(b, row); });
  return m_uniformRows.row(leaf.getValue(), [&](float value, double* row) {
    layout.rowOf(m_gTree.m_filter.uniform(value), row);
  });
}

void GTree::Worker::gatherRows(const NodeStore& store, const Node& inner, const double** rows,
                               double* gValues) {
  const Octant& octant = NodeStore::octant(inner);
  InnerState& state = *store.state<InnerState>(inner);
  m_uniformRows.release();
  m_recordRows.release();
  unsigned kinds = 0;
  for (int i = 0; i < 8; ++i) {
    const Node& child = octant.nodes[i];
    gValues[i] = 0;
    if (!octant.has(i)) {
      rows[i] = m_gTree.layout().unknownRow();
    } else if (child.isLeaf()) {
      kinds |= 1u << 2 * i;
      rows[i] = rowOf(store, child);
    } else {
      kinds |= 2u << 2 * i;
      const InnerState& s = *store.state<InnerState>(child);
      rows[i] = s.row();
      gValues[i] = s.gValue;
      state.changedBelow |= s.changedBelow;
    }
  }
  state.changedBelow |= state.childKinds != kinds;
  state.childKinds = static_cast<std::uint16_t>(kinds);
}

void GTree::Worker::recompute(NodeStore& store, Node& inner, const Cell& cell) {
  InnerState& s = *store.state<InnerState>(inner);
  double* const js = m_gTree.divergences(s);
  const double* rows[8];
  double gValues[8], densities[8], shares[8];
  gatherRows(store, inner, rows, gValues);
  bool equalShares = m_gTree.hasEqualShares(cell.depth);
  if (equalShares) {
    s.density = 1;
  } else {
    gatherDensities(store, inner, cell, densities);
    equalShares = sharesOf(densities, shares);
    s.density = sumOfEight(densities) * 0.125;
  }
  m_gTree.layout().mix(rows, equalShares ? nullptr : shares, s.row(), js);
  s.splitEntropy = equalShares ? kLogEight : entropyOfShares(shares);
  if (s.density == 0) {
    s.splitEntropy = 0;
    std::fill(js, js + m_gTree.layout().sizes().terms, 0.0);
  }
  m_gTree.settleG(s, cell.depth,
                  equalShares ? sumOfEight(gValues) * 0.125 : weightedSumOfEight(shares, gValues));
}

void GTree::Worker::recomputeAll(NodeStore& store, Node& node, const Cell& cell) {
  if (node.isLeaf()) return;
  Octant& octant = NodeStore::octant(node);
  for (int i = 0; i < 8; ++i)
    if (octant.has(i)) recomputeAll(store, octant.nodes[i], cell.child(i));
  recompute(store, node, cell);
}

bool GTree::Worker::recomputeWhereChanged(NodeStore& store, Node& node, const Cell& cell,
                                          const DensityField& before) {
  if (DensityField::sameIn(before, m_gTree.density(), cell)) return false;
  if (node.isLeaf()) return true;
  Octant& octant = NodeStore::octant(node);
  bool changed = false;
  for (int i = 0; i < 8; ++i) {
    const Cell child = cell.child(i);
    changed |= octant.has(i) ? recomputeWhereChanged(store, octant.nodes[i], child, before)
                             : !DensityField::sameIn(before, m_gTree.density(), child);
  }
  if (changed) recompute(store, node, cell);
  return changed;
}

void GTree::Worker::reweigh(NodeStore& store, Node& inner, const Cell& cell) {
  InnerState& s = *store.state<InnerState>(inner);
  double gValues[8] = {};
  // The parents of voxels are most of all nodes: their children need not be looked at.
  if (cell.depth < kTreeDepth - 1) reweighChildren(store, inner, cell, gValues);
  double childrensG = sumOfEight(gValues) * 0.125;
  if (!m_gTree.hasEqualShares(cell.depth)) {
    double densities[8], shares[8];
    gatherDensities(store, inner, cell, densities);
    sharesOf(densities, shares);
    childrensG = weightedSumOfEight(shares, gValues);
  }
  m_gTree.settleG(s, cell.depth, childrensG);
}

void GTree::Worker::reweighChildren(NodeStore& store, Node& inner, const Cell& cell,
                                    double* gValues) {
  Octant& octant = NodeStore::octant(inner);
  store.prefetchChildren(inner);
  std::uint8_t changed = store.state<InnerState>(inner)->changedBelow;
  for (int i = 0; i < 8; ++i) {
    Node& child = octant.nodes[i];
    if (child.isLeaf()) continue;
    reweigh(store, child, cell.child(i));
    const InnerState& below = *store.state<InnerState>(child);
    gValues[i] = below.gValue;
    changed |= below.changedBelow;
  }
  store.state<InnerState>(inner)->changedBelow = changed;
}

void GTree::Worker::gatherDensities(const NodeStore& store, const Node& inner, const Cell& cell,
                                    double* densities) const {
  const Octant& octant = NodeStore::octant(inner);
  const double missing = m_gTree.missingDensity(cell.depth + 1);
  for (int i = 0; i < 8; ++i) {
    const Node& child = octant.nodes[i];
    if (octant.has(i) && !child.isLeaf())
      densities[i] = store.state<InnerState>(child)->density;
    else
      densities[i] = (octant.has(i) ? 1.0 : missing) * m_gTree.density().mean(cell.child(i));
  }
}

}  // namespace semantic_octree
