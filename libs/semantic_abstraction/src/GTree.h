#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/store/Cubes.h>
#include <semantic_octree/store/NodeObserver.h>

#include <algorithm>
#include <deque>
#include <optional>

#include "RowLayout.h"

namespace semantic_octree {

/** Density of p(x) over space: 1, or the largest weight of the regions that a voxel's center is in.
 * A cell's is the mean over its voxels, exactly, so that cells add up to their parent. */
class DensityField {
 public:
  DensityField() = default;
  DensityField(std::vector<Region> regions, double resolution);

  double mean(const Cube& cell) const { return m_regions.empty() ? 1.0 : meanInRegions(cell); }
  /** The density of all of the cell, unless a border between densities may cross it. */
  std::optional<double> constantIn(const Cube& cell) const {
    return m_regions.empty() ? 1.0 : constantInRegions(cell);
  }

 private:
  enum class Overlap { None, Part, Full };
  Overlap overlap(const Region& region, const Cube& cell) const;
  std::optional<double> constantInRegions(const Cube& cell) const;
  double meanInRegions(const Cube& cell) const;

  std::vector<Region> m_regions;
  double m_resolution = 1;
};

class LeafLog;

/** Bookkeeping of a Block: nothing but its part in the compressed tree. Its row is computed when
 * its parent's is, from the voxels: to keep it would take more memory, and no less time. */
struct BlockState {
  std::uint8_t isExpanded;       ///< in the compressed tree if the parent is
  std::uint8_t changedBelow;     ///< the compressed tree's leaves may have changed since last told
  std::uint8_t expandedOctants;  ///< those of a block whose isExpanded would be set
};
static_assert(sizeof(BlockState) <= NodeStore::kBlockStateBytes);

/** Bookkeeping of an inner node above the Blocks. Behind it stands the node's row (see RowLayout).
 * All of it is a function of the children alone. */
struct InnerState : BlockState {
  std::uint16_t childKinds;  ///< two bits each: no child, a leaf, an inner node
  double density;  ///< mean density of p(x) in the cell; p(n) = density * volume, unnormalized
  double gValue;   ///< G_Pi; above the blocks, if they are free, the mean of the children's

  double* row() { return reinterpret_cast<double*>(this + 1); }
  const double* row() const { return reinterpret_cast<const double*>(this + 1); }
};

/** What is computed of an inner node beside its row and divergences. */
struct NodeSummary {
  double density = 0, gValue = 0;
  double splitEntropy = 0;        ///< H(Pi), nats
  double weightedDivergence = 0;  ///< sum_t weight_t JS_t
  bool isExpanded = false;
};

/** An inner node that is inspected. */
struct InnerNode : NodeSummary {
  Cube cell;
  int numChildren = 0;
  const double* row = nullptr;
  const double* divergences = nullptr;  ///< JS_t, nats, in the layout's order
};

/** The first half of G-tree search (Larsson et al., algorithm 1) in a map that grows. From the
 * leaves up, it computes inner nodes' weight, class mixture, divergences, and the G-value
 *   G_Pi(n) = max(0, sum_t weight_t JS_t(n) - alpha H(Pi_n) + sum_c Pi_c G_Pi(c)),
 * where alpha and the weights are those of AbstractionOptions. The second half is CompressedTree.
 *
 * A scan recomputes the nodes above the voxels that it changed, each once, from their eight
 * children. None is adjusted, so the order of updates leaves no trace. */
class GTree final : public NodeObserver {
 public:
  GTree(const AbstractionOptions& options, const ClassFilter& filter, double resolution);

  const AbstractionOptions& options() const { return m_options; }
  const RowLayout& layout() const { return m_layout; }
  std::size_t stateBytes() const override;
  /** What a node is, not what was told of it. */
  bool sameState(const NodeStore& a, const Slot& inA, const NodeStore& b,
                 const Slot& inB) const override;
  void tellAll() override { leafLog.reset(); }
  std::unique_ptr<NodeObserver> clone() const override;

  /** Depth of the blocks' nodes: at this depth and below, unknown space has weight. */
  int blockDepth() const { return m_blockDepth; }
  /** Above the blocks, and free of charge. */
  bool isFreeFrame(int depth) const {
    return depth < m_blockDepth && m_options.frame == AbstractionOptions::Frame::Free;
  }

  /** Whether unknown space of a depth counts as known space does. Above the blocks, where most of
   * it is huge, it does not. */
  bool unknownCounts(int depth) const { return depth > m_blockDepth; }
  /** The density of a node whose eight children weigh the same, known or not; none if a border
   * between densities may cross it. */
  std::optional<double> equalDensity(const Cube& cell) const {
    if (!unknownCounts(cell.depth + 1)) return {};
    return m_density.constantIn(cell);
  }
  const DensityField& density() const { return m_density; }
  /** The share of a cell without inner nodes. */
  double densityOf(bool isKnown, const Cube& cell) const {
    return isKnown || unknownCounts(cell.depth) ? m_density.mean(cell) : 0.0;
  }

  /** New weights of the same terms, and alpha. What is kept of nodes is then out of date. */
  void setWeights(const std::vector<double>& termWeights, double alpha);
  void setRegions(std::vector<Region> regions);

  /** One thread's part: buffers, and rows of frequent values. */
  class Worker final : public NodeObserver::Worker {
   public:
    explicit Worker(const GTree& gTree);
    /** Before the weights change. */
    void forgetGValues() { m_patterns.clear(); }
    void recompute(NodeStore& store, Slot& inner, const Cube& cell, bool reshaped) override;
    /** Nodes in whose cell the density may not be what it was. \return whether there were any */
    bool recomputeWhereChanged(NodeStore& store, Slot& slot, const Cube& cell,
                               const DensityField& before);
    /** Calls f(node) for an inner node that is a slot, then for its octants that are inner nodes if
     * it is a block. */
    template <typename F>
    void inspect(const NodeStore& store, const Slot& inner, const Cube& cell, const F& f);

   private:
    /** What a node needs of its eight children. */
    struct Children {
      const double* rows[8];
      double gValues[8] = {};
      double densities[8];  ///< unless the node's cell has an equal density
    };
    /** Density of a cell whose children weigh the same (see equalDensity()). */
    using EqualDensity = std::optional<double>;

    /** Notes in the state whether the children's part in the compressed tree changed. */
    static void noteChildren(const NodeStore& store, const Slot& inner, InnerState& s);
    /** What a block's parent needs of it. The block's state is up to date then. */
    void addBlock(const NodeStore& store, const Slot& inner, const Cube& cell, int child,
                  Children& c);
    NodeSummary computeOctant(const NodeStore& store, const Slot& inner, const Cube& cell,
                              double* row);
    /** The block's own node, and m_expandedOctants. */
    NodeSummary computeBlock(const NodeStore& store, const Slot& inner, const Cube& cell,
                             double* row);
    /** An octant of a block without class records, where the density is equal: its values count,
     * and not where they stand. \param pattern its values in ascending order */
    NodeSummary computePattern(const OctantPattern& pattern, double density, double* row);
    /** An octant of a block that is an inner node. \param records the octant's
     * \param blocksDensity if the block has an equal one */
    NodeSummary computeOctantOfBlock(const Block& block, int octant, const ClassRecord* records,
                                     const Cube& cell, const EqualDensity& blocksDensity,
                                     double* row);
    /** What a block's node needs of an octant. */
    void addOctant(const Block& block, int octant, const ClassRecord* records, const Cube& cell,
                   const EqualDensity& blocksDensity, Children& c);
    /** Row, divergences (m_divergences), and the rest. */
    NodeSummary compute(const Children& children, const EqualDensity& equalDensity, int depth,
                        double* row);
    InnerNode inspected(const NodeSummary& summary, const Cube& cell, int numChildren,
                        const double* row) const;
    const double* rowOf(const ClassRecord& record);
    const double* rowOf(Units value);
    /** Rows of leaves asked for up to now are not in use any more. */
    void releaseRows();
    double* buffer(int i) { return &m_buffers[i * m_gTree.layout().rowSize()]; }

    const GTree& m_gTree;
    RowTable<Units> m_values;  ///< of leaves without a class record
    RowTable<ClassRecord> m_records;
    RowTable<OctantPattern> m_patterns;  ///< of octants without class records
    /** Rows of a block's octants, of a tile's blocks, and of a node that is inspected. */
    std::vector<double> m_buffers;
    std::vector<double> m_divergences;  ///< JS_t of the node that was computed last
    unsigned m_expandedOctants = 0;
    static constexpr int kBlocks = 8, kOwn = 16;
  };
  Worker& worker(int i) override;

  /** Changes of the compressed tree's leaves; readers own what they read. */
  std::weak_ptr<LeafLog> leafLog;

 private:
  AbstractionOptions m_options;
  RowLayout m_layout;
  ClassFilter m_filter;
  double m_resolution;
  int m_blockDepth;
  double m_eps;
  std::vector<double> m_weights;  ///< in the layout's order
  DensityField m_density;
  std::deque<Worker> m_workers;
};

template <typename F>
void GTree::Worker::inspect(const NodeStore& store, const Slot& inner, const Cube& cell,
                            const F& f) {
  double* const row = buffer(kOwn);
  if (inner.kind == Slot::Kind::Octant) {
    const NodeSummary summary = computeOctant(store, inner, cell, row);
    const Slot* const slots = store.octant(inner).slots;
    const auto known = std::count_if(slots, slots + 8, [](const Slot& s) { return s.isKnown(); });
    return f(inspected(summary, cell, static_cast<int>(known), row));
  }
  const Block& block = store.block(inner);
  int known = 0;
  for (int o = 0; o < 8; ++o) known += block.knownIn(o) != 0;
  f(inspected(computeBlock(store, inner, cell, row), cell, known, row));
  const EqualDensity density = m_gTree.equalDensity(cell);
  for (int o = 0; o < 8; ++o) {
    if (!block.knownIn(o) || block.isLeafOctant(o)) continue;
    const ClassRecord* records =
        block.recorded ? store.recordsOf(block) + block.rankOfRecord(8 * o) : nullptr;
    const Cube octant = cell.child(o);
    f(inspected(computeOctantOfBlock(block, o, records, octant, density, row), octant,
                countOf(block.knownIn(o)), row));
  }
}

}  // namespace semantic_octree
