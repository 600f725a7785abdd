#include "GTree.h"

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>
#include <cstring>

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
      m_resolution(resolution),
      m_blockDepth(depthOfBlocks(options.blockSize, resolution)),
      m_density(options.regions, resolution) {
  std::vector<double> termWeights;
  for (const auto& term : options.weights.terms) termWeights.push_back(term.weight);
  setWeights(termWeights, options.weights.alpha);
}

std::size_t GTree::stateBytes() const {
  return sizeof(InnerState) + m_layout.rowSize() * sizeof(double);
}

bool GTree::sameState(const NodeStore& a, const Slot& inA, const NodeStore& b,
                      const Slot& inB) const {
  const InnerState &x = *a.state<InnerState>(inA), &y = *b.state<InnerState>(inB);
  return x.density == y.density && x.gValue == y.gValue && x.isExpanded == y.isExpanded &&
         x.expandedOctants == y.expandedOctants &&
         std::memcmp(x.row(), y.row(), stateBytes() - sizeof(InnerState)) == 0;
}

std::unique_ptr<NodeObserver> GTree::clone() const {
  return std::make_unique<GTree>(m_options, m_filter, m_resolution);
}

void GTree::setWeights(const std::vector<double>& termWeights, double alpha) {
  m_weights.assign(m_layout.sizes().terms, 0.0);
  for (std::size_t t = 0; t < termWeights.size(); ++t) {
    m_options.weights.terms[t].weight = termWeights[t];
    m_weights[m_layout.positionOf(static_cast<int>(t))] = termWeights[t];
  }
  m_options.weights.alpha = alpha;
  for (Worker& worker : m_workers) worker.forgetGValues();
  m_eps = m_options.weights.eps();
}

void GTree::setRegions(std::vector<Region> regions) {
  DensityField density(regions, m_resolution);
  std::swap(m_options.regions, regions);
  std::swap(m_density, density);
}

GTree::Worker& GTree::worker(int i) {
  while (static_cast<int>(m_workers.size()) <= i) m_workers.emplace_back(*this);
  return m_workers[i];
}

GTree::Worker::Worker(const GTree& gTree)
    : m_gTree(gTree),
      m_valueRows(gTree.layout().rowSize()),
      m_recordRows(gTree.layout().rowSize()),
      m_bufferSize(gTree.layout().rowSize() + gTree.layout().sizes().terms + 3),
      m_buffers((kOwn + 1) * m_bufferSize),
      m_patterns(m_bufferSize) {}

const double* GTree::Worker::rowOf(const ClassRecord& record) {
  return m_recordRows.row(
      record, [&](const ClassRecord& r, double* row) { m_gTree.layout().rowOf(r.belief(), row); });
}

const double* GTree::Worker::rowOf(Units value) {
  return m_valueRows.row(value, [&](Units v, double* row) {
    if (v == kUnknown)
      std::copy_n(m_gTree.layout().unknownRow(), m_gTree.layout().rowSize(), row);
    else
      m_gTree.layout().rowOf(m_gTree.m_filter.uniform(fromUnits(v)), row);
  });
}

InnerNode GTree::Worker::compute(const Children& children, const Cell& cell, double* buffer) {
  const GTree& g = m_gTree;
  double* const row = buffer;
  double* const js = row + g.layout().rowSize();
  InnerNode n;
  n.cell = cell;
  n.numChildren = children.number;
  n.row = row;
  n.divergences = js;
  double shares[8];
  const std::optional<double> equalDensity = g.equalDensity(cell);
  bool equalShares = equalDensity.has_value();
  if (equalShares) {
    n.density = *equalDensity;
  } else {
    equalShares = sharesOf(children.densities, shares);
    n.density = sumOfEight(children.densities) * 0.125;
  }
  g.layout().mix(children.rows, equalShares ? nullptr : shares, row, js);
  if (n.density == 0)
    std::fill(js, js + g.layout().sizes().terms, 0.0);
  else
    n.splitEntropy = equalShares ? kLogEight : entropyOfShares(shares);
  const double childrensG = equalShares ? sumOfEight(children.gValues) * 0.125
                                        : weightedSumOfEight(shares, children.gValues);
  for (std::size_t t = 0; t < g.m_weights.size(); ++t)
    n.weightedDivergence += g.m_weights[t] * js[t];
  const double v = childrensG - g.m_options.weights.alpha * n.splitEntropy + n.weightedDivergence;
  const bool isFree = g.isFreeFrame(cell.depth);
  n.gValue = isFree ? childrensG : std::max(v, 0.0);
  n.isExpanded = isFree || v > g.m_eps;
  return n;
}

auto GTree::Worker::childrenOf(const NodeStore& store, const Slot& inner, const Cell& cell)
    -> Children {
  const Octant& octant = store.octant(inner);
  const bool needDensities = !m_gTree.equalDensity(cell);
  m_recordRows.release();
  Children c;
  for (int i = 0; i < 8; ++i) {
    const Slot& child = octant.slots[i];
    c.number += child.isKnown();
    if (child.isInner()) {
      const InnerState& s = *store.state<InnerState>(child);
      c.rows[i] = s.row();
      c.gValues[i] = s.gValue;
      c.densities[i] = s.density;
      continue;
    }
    c.rows[i] = child.kind == Slot::Kind::LeafWithRecord ? rowOf(store.record(child))
                : child.isKnown()                        ? rowOf(child.value)
                                                         : m_gTree.layout().unknownRow();
    if (needDensities) c.densities[i] = m_gTree.densityOf(child.isKnown(), cell.child(i));
  }
  return c;
}

InnerNode GTree::Worker::computeOctant(const NodeStore& store, const Slot& inner,
                                       const Cell& cell) {
  return compute(childrenOf(store, inner, cell), cell, buffer(kOwn));
}

InnerNode GTree::Worker::computeOctantOfBlock(const NodeStore& store, const Block& block,
                                              int octant, const Cell& cell, double* buffer) {
  m_recordRows.release();
  Children c;
  c.number = countOf(block.knownIn(octant));
  const ClassRecord* record =
      block.recorded ? store.recordsOf(block) + block.rankOfRecord(8 * octant) : nullptr;
  for (int i = 0; i < 8; ++i) {
    const int voxel = 8 * octant + i;
    c.rows[i] = block.recorded >> voxel & 1 ? rowOf(*record++) : rowOf(block.values[voxel]);
  }
  if (!m_gTree.equalDensity(cell))
    for (int i = 0; i < 8; ++i)
      c.densities[i] = m_gTree.densityOf(block.knownIn(octant) >> i & 1, cell.child(i));
  const InnerNode n = compute(c, cell, buffer);
  buffer[m_bufferSize - 3] = n.gValue;
  buffer[m_bufferSize - 2] = n.density;
  buffer[m_bufferSize - 1] = n.isExpanded;
  return n;
}

const double* GTree::Worker::bufferOf(const NodeStore& store, const Block& block, int octant,
                                      const Cell& cell) {
  if (octantOf(block.recorded, octant) == 0 && m_gTree.equalDensity(cell) == 1.0)
    return m_patterns.row(OctantPattern(block.values + 8 * octant),
                          [&](const OctantPattern&, double* row) {
                            computeOctantOfBlock(store, block, octant, cell, row);
                          });
  computeOctantOfBlock(store, block, octant, cell, buffer(octant));
  return buffer(octant);
}

InnerNode GTree::Worker::computeBlock(const NodeStore& store, const Slot& inner, const Cell& cell) {
  const Block& block = store.block(inner);
  const bool needDensities = !m_gTree.equalDensity(cell);
  m_patterns.release();
  m_expandedOctants = 0;
  Children c;
  for (int o = 0; o < 8; ++o) {
    const bool isKnown = block.knownIn(o);
    c.number += isKnown;
    if (isKnown && !block.isLeafOctant(o)) {
      c.rows[o] = bufferOf(store, block, o, cell.child(o));
      c.gValues[o] = c.rows[o][m_bufferSize - 3];
      c.densities[o] = c.rows[o][m_bufferSize - 2];
      m_expandedOctants |= static_cast<unsigned>(c.rows[o][m_bufferSize - 1]) << o;
      continue;
    }
    if (block.hasRecord(8 * o)) {
      // A row of the cache lasts until the next octant's are asked for.
      const double* row = rowOf(store.record(block, 8 * o));
      c.rows[o] =
          std::copy_n(row, m_gTree.layout().rowSize(), buffer(o)) - m_gTree.layout().rowSize();
    } else {
      c.rows[o] = rowOf(block.values[8 * o]);
    }
    if (needDensities) c.densities[o] = m_gTree.densityOf(isKnown, cell.child(o));
  }
  return compute(c, cell, buffer(kOwn));
}

void GTree::Worker::recompute(NodeStore& store, Slot& inner, const Cell& cell, bool reshaped) {
  const bool isBlock = inner.kind == Slot::Kind::Block;
  const InnerNode n =
      isBlock ? computeBlock(store, inner, cell) : computeOctant(store, inner, cell);
  InnerState& s = *store.state<InnerState>(inner);
  s.density = n.density;
  s.gValue = n.gValue;
  std::copy_n(n.row, m_gTree.layout().rowSize(), s.row());
  s.changedBelow |= reshaped || s.isExpanded != n.isExpanded;
  s.isExpanded = n.isExpanded;
  isBlock ? noteOctants(s) : noteChildren(store, inner, s);
}

void GTree::Worker::noteOctants(InnerState& s) const {
  s.changedBelow |= s.expandedOctants != m_expandedOctants;
  s.expandedOctants = static_cast<std::uint8_t>(m_expandedOctants);
}

void GTree::Worker::noteChildren(const NodeStore& store, const Slot& inner, InnerState& s) {
  const Octant& octant = store.octant(inner);
  unsigned kinds = 0;
  for (int i = 0; i < 8; ++i) {
    const Slot& child = octant.slots[i];
    kinds |= (child.isInner() ? 2u : child.isKnown() ? 1u : 0u) << 2 * i;
    if (child.isInner()) s.changedBelow |= store.state<InnerState>(child)->changedBelow;
  }
  s.changedBelow |= s.childKinds != kinds;
  s.childKinds = static_cast<std::uint16_t>(kinds);
}

bool GTree::Worker::recomputeWhereChanged(NodeStore& store, Slot& slot, const Cell& cell,
                                          const DensityChange& change) {
  if (change.noneIn(cell)) return false;
  if (slot.isKnown() && !slot.isInner()) return true;
  store.bring(slot);
  bool changed = slot.kind != Slot::Kind::Octant;
  if (slot.kind == Slot::Kind::Octant)
    for (int i = 0; i < 8; ++i)
      changed |= recomputeWhereChanged(store, store.octant(slot).slots[i], cell.child(i), change);
  if (changed && slot.isInner()) recompute(store, slot, cell, false);
  return changed;
}

}  // namespace semantic_octree
