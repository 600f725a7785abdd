#include "GTree.h"

#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace semantic_octree {
namespace {

/** Distance from a point to the stretch a-b (to a if both are the same). */
double distanceToStretch(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

}  // namespace

DensityField::DensityField(std::vector<Region> regions, double resolution)
    : m_regions(std::move(regions)), m_resolution(resolution) {}

DensityField::Overlap DensityField::overlap(const Region& region, const Cube& cell) const {
  // Centers of the cell's voxels fill the box center +- reach.
  const double reach = 0.5 * (cell.edge() - 1) * m_resolution;
  const Eigen::Vector3d center =
      ((cell.lowest - kKeyOfOrigin).cast<double>() + 0.5 * cell.edge()).matrix() * m_resolution;
  if (region.shape == Region::Shape::Box) {
    const Eigen::Array3d toLow = (center - region.a).array(), toHigh = (region.b - center).array();
    if ((toLow >= reach).all() && (toHigh >= reach).all()) return Overlap::Full;
    if ((toLow < -reach).any() || (toHigh < -reach).any()) return Overlap::None;
    return Overlap::Part;
  }
  const double distance = region.shape == Region::Shape::Sphere
                              ? (center - region.a).norm()
                              : distanceToStretch(center, region.a, region.b);
  const double halfDiagonal = std::sqrt(3.0) * reach;
  if (distance + halfDiagonal <= region.radius) return Overlap::Full;
  return distance - halfDiagonal > region.radius ? Overlap::None : Overlap::Part;
}

std::optional<double> DensityField::constantInRegions(const Cube& cell) const {
  double inAll = -1, inPart = -1;  // largest weights
  for (const Region& region : m_regions) {
    const Overlap overlap = this->overlap(region, cell);
    if (overlap == Overlap::None) continue;
    double& largest = overlap == Overlap::Full ? inAll : inPart;
    largest = std::max(largest, region.weight);
  }
  if (inPart > inAll) return {};
  return inAll < 0 ? 1.0 : inAll;
}

double DensityField::meanInRegions(const Cube& cell) const {
  if (const auto density = constantInRegions(cell)) return *density;  // as in all voxels
  double d[8];
  for (int i = 0; i < 8; ++i) d[i] = meanInRegions(cell.child(i));
  return (((d[0] + d[1]) + (d[2] + d[3])) + ((d[4] + d[5]) + (d[6] + d[7]))) * 0.125;
}

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

GTree::GTree(const AbstractionOptions& options, const ClassFilter& filter, double resolution)
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
  const BlockState &p = *a.state<BlockState>(inA), &q = *b.state<BlockState>(inB);
  if (p.isExpanded != q.isExpanded || p.expandedOctants != q.expandedOctants) return false;
  if (inA.kind == Slot::Kind::Block) return true;
  const InnerState &x = *a.state<InnerState>(inA), &y = *b.state<InnerState>(inB);
  return x.density == y.density && x.gValue == y.gValue &&
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
      m_values(gTree.layout().rowSize()),
      m_records(gTree.layout().rowSize()),
      m_patterns(gTree.layout().rowSize()),
      m_buffers((kOwn + 1) * gTree.layout().rowSize()),
      m_divergences(gTree.layout().sizes().terms) {}

const double* GTree::Worker::rowOf(const ClassRecord& record) {
  return m_records
      .find(record,
            [&](const ClassRecord& r, double* row) {
              m_gTree.layout().rowOf(r.belief(), row);
              return 0.0;
            })
      .row;
}

const double* GTree::Worker::rowOf(Units value) {
  return m_values
      .find(value,
            [&](Units v, double* row) {
              if (v == kUnknown)
                std::copy_n(m_gTree.layout().unknownRow(), m_gTree.layout().rowSize(), row);
              else
                m_gTree.layout().rowOf(m_gTree.m_filter.uniform(fromUnits(v)), row);
              return 0.0;
            })
      .row;
}

void GTree::Worker::releaseRows() {
  m_values.release();
  m_records.release();
}

NodeSummary GTree::Worker::compute(const Children& children, const EqualDensity& equalDensity,
                                   int depth, double* row) {
  const GTree& g = m_gTree;
  NodeSummary n;
  double shares[8];
  bool equalShares = equalDensity.has_value();
  if (equalShares) {
    n.density = *equalDensity;
  } else {
    equalShares = sharesOf(children.densities, shares);
    n.density = sumOfEight(children.densities) * 0.125;
  }
  const double childrensG = equalShares ? sumOfEight(children.gValues) * 0.125
                                        : weightedSumOfEight(shares, children.gValues);
  n.weightedDivergence = g.layout().mix(children.rows, equalShares ? nullptr : shares,
                                        g.m_weights.data(), row, m_divergences.data());
  if (n.density == 0) {
    std::fill(m_divergences.begin(), m_divergences.end(), 0.0);
    n.weightedDivergence = 0;
  } else {
    n.splitEntropy = equalShares ? kLogEight : entropyOfShares(shares);
  }
  const double v = childrensG - g.m_options.weights.alpha * n.splitEntropy + n.weightedDivergence;
  const bool isFree = g.isFreeFrame(depth);
  n.gValue = isFree ? childrensG : std::max(v, 0.0);
  n.isExpanded = isFree || v > g.m_eps;
  return n;
}

NodeSummary GTree::Worker::computeOctant(const NodeStore& store, const Slot& inner,
                                         const Cube& cell, double* row) {
  const Octant& octant = store.octant(inner);
  const EqualDensity equalDensity = m_gTree.equalDensity(cell);
  Children c;
  for (int i = 0; i < 8; ++i)
    if (octant.slots[i].kind == Slot::Kind::Block)
      addBlock(store, octant.slots[i], cell.child(i), i, c);
  releaseRows();
  for (int i = 0; i < 8; ++i) {
    const Slot& child = octant.slots[i];
    if (child.kind == Slot::Kind::Block) continue;
    if (child.isInner()) {
      const InnerState& s = *store.state<InnerState>(child);
      c.rows[i] = s.row();
      c.gValues[i] = s.gValue;
      c.densities[i] = s.density;
      continue;
    }
    c.rows[i] = child.kind == Slot::Kind::LeafWithRecord
                    ? rowOf(store.record(child))
                    : rowOf(child.isKnown() ? child.value : kUnknown);
    if (!equalDensity) c.densities[i] = m_gTree.densityOf(child.isKnown(), cell.child(i));
  }
  return compute(c, equalDensity, cell.depth, row);
}

NodeSummary GTree::Worker::computePattern(const OctantPattern& pattern, double density,
                                          double* row) {
  releaseRows();
  Children c;
  for (int i = 0; i < 8; ++i) c.rows[i] = rowOf(pattern.values[i]);
  return compute(c, density, Block::kDepth + 1, row);
}

NodeSummary GTree::Worker::computeOctantOfBlock(const Block& block, int octant,
                                                const ClassRecord* records, const Cube& cell,
                                                const EqualDensity& blocksDensity, double* row) {
  // In a cell of equal density, its children's is the same.
  const EqualDensity density = blocksDensity ? blocksDensity : m_gTree.equalDensity(cell);
  const Units* const values = block.values + 8 * octant;
  const unsigned recorded = octantOf(block.recorded, octant);
  if (!recorded && density) {
    OctantPattern pattern;
    std::copy_n(values, 8, pattern.values);
    std::sort(pattern.values, pattern.values + 8);
    return computePattern(pattern, *density, row);
  }
  releaseRows();
  Children c;
  for (int i = 0; i < 8; ++i) c.rows[i] = recorded >> i & 1 ? rowOf(*records++) : rowOf(values[i]);
  if (!density)
    for (int i = 0; i < 8; ++i)
      c.densities[i] = m_gTree.densityOf(values[i] != kUnknown, cell.child(i));
  return compute(c, density, cell.depth, row);
}

void GTree::Worker::addOctant(const Block& block, int octant, const ClassRecord* records,
                              const Cube& cell, const EqualDensity& blocksDensity, Children& c) {
  const bool isKnown = block.knownIn(octant);
  if (isKnown && !block.isLeafOctant(octant)) {
    const NodeSummary n =
        computeOctantOfBlock(block, octant, records, cell, blocksDensity, buffer(octant));
    c.rows[octant] = buffer(octant);
    c.gValues[octant] = n.gValue;
    c.densities[octant] = n.density;
    m_expandedOctants |= static_cast<unsigned>(n.isExpanded) << octant;
    return;
  }
  releaseRows();  // so that the next octant's rows may take its place
  const double* const row =
      octantOf(block.recorded, octant) ? rowOf(*records) : rowOf(block.values[8 * octant]);
  std::copy_n(row, m_gTree.layout().rowSize(), buffer(octant));
  c.rows[octant] = buffer(octant);
  if (!blocksDensity) c.densities[octant] = m_gTree.densityOf(isKnown, cell);
}

NodeSummary GTree::Worker::computeBlock(const NodeStore& store, const Slot& inner, const Cube& cell,
                                        double* row) {
  const Block& block = store.block(inner);
  const EqualDensity density = m_gTree.equalDensity(cell);
  const bool hasPatterns = density && *density > 0;
  OctantPattern patterns[8];
  if (hasPatterns) sortOctants(block.values, patterns[0].values);
  m_patterns.release();
  m_expandedOctants = 0;
  unsigned expanded = 0;
  Children c;
  const ClassRecord* records = block.recorded ? store.recordsOf(block) : nullptr;
  for (int o = 0; o < 8; ++o) {
    const std::uint8_t recorded = octantOf(block.recorded, o);
    if (recorded == 0 && hasPatterns) {
      const auto& entry = m_patterns.find(patterns[o], [&](const OctantPattern& p, double* ofIt) {
        return computePattern(p, *density, ofIt).gValue;
      });
      c.rows[o] = entry.row;
      c.gValues[o] = entry.gValue;
      expanded |= static_cast<unsigned>(entry.gValue > m_gTree.m_eps) << o;
    } else {
      addOctant(block, o, records, cell.child(o), density, c);
      records += countOf(recorded);
    }
  }
  m_expandedOctants |= expanded;
  return compute(c, density, cell.depth, row);
}

InnerNode GTree::Worker::inspected(const NodeSummary& summary, const Cube& cell, int numChildren,
                                   const double* row) const {
  return {summary, cell, numChildren, row, m_divergences.data()};
}

void GTree::Worker::addBlock(const NodeStore& store, const Slot& inner, const Cube& cell, int child,
                             Children& c) {
  double* const row = buffer(kBlocks + child);
  const NodeSummary n = computeBlock(store, inner, cell, row);
  c.rows[child] = row;
  c.gValues[child] = n.gValue;
  c.densities[child] = n.density;
  BlockState& s = *store.state<BlockState>(inner);
  if (s.isExpanded != n.isExpanded || s.expandedOctants != m_expandedOctants)
    s = {n.isExpanded, true, static_cast<std::uint8_t>(m_expandedOctants)};
}

void GTree::Worker::recompute(NodeStore& store, Slot& inner, const Cube& cell, bool reshaped) {
  store.state<BlockState>(inner)->changedBelow |= reshaped;
  if (inner.kind == Slot::Kind::Block) return;  // its parent comes next
  InnerState& s = *store.state<InnerState>(inner);
  const NodeSummary n = computeOctant(store, inner, cell, s.row());
  s.density = n.density;
  s.gValue = n.gValue;
  s.changedBelow |= s.isExpanded != n.isExpanded;
  s.isExpanded = n.isExpanded;
  noteChildren(store, inner, s);
}

void GTree::Worker::noteChildren(const NodeStore& store, const Slot& inner, InnerState& s) {
  unsigned kinds = 0;
  for (int i = 0; i < 8; ++i) {
    const Slot& child = store.octant(inner).slots[i];
    kinds |= (child.isInner() ? 2u : child.isKnown() ? 1u : 0u) << 2 * i;
    if (child.isInner()) s.changedBelow |= store.state<BlockState>(child)->changedBelow;
  }
  s.changedBelow |= s.childKinds != kinds;
  s.childKinds = static_cast<std::uint16_t>(kinds);
}

bool GTree::Worker::recomputeWhereChanged(NodeStore& store, Slot& slot, const Cube& cell,
                                          const DensityField& before) {
  const auto density = before.constantIn(cell);
  if (density && density == m_gTree.density().constantIn(cell)) return false;
  if (slot.isKnown() && !slot.isInner()) return true;
  store.bring(slot);
  bool changed = slot.kind != Slot::Kind::Octant;
  if (slot.kind == Slot::Kind::Octant)
    for (int i = 0; i < 8; ++i)
      changed |= recomputeWhereChanged(store, store.octant(slot).slots[i], cell.child(i), before);
  if (changed && slot.isInner()) recompute(store, slot, cell, false);
  return changed;
}

}  // namespace semantic_octree
