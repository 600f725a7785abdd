#pragma once
#include <semantic_octree/ClassFilter.h>
#include <semantic_octree/store/Cell.h>
#include <semantic_octree/store/NodeObserver.h>

#include <deque>

#include "DensityField.h"
#include "RowLayout.h"

namespace semantic_octree {

class LeafLog;

/** Bookkeeping of an inner node at depth 14 or above. Behind it stands the node's row (see
 * RowLayout). All of it is a function of the children alone. */
struct InnerState {
  double density;  ///< mean density of p(x) in the cell; p(n) = density * volume, unnormalized
  double gValue;   ///< G_Pi; above the blocks, if they are free, the mean of the children's
  std::uint16_t childKinds;      ///< two bits each: no child, a leaf, an inner node
  std::uint8_t isExpanded;       ///< in the compressed tree if the parent is
  std::uint8_t changedBelow;     ///< the compressed tree's leaves may have changed since last told
  std::uint8_t expandedOctants;  ///< of a block's octants, those whose isExpanded would be set

  double* row() { return reinterpret_cast<double*>(this + 1); }
  const double* row() const { return reinterpret_cast<const double*>(this + 1); }
};

/** What is computed of an inner node, but not kept. */
struct InnerNode {
  Cell cell;
  int numChildren = 0;
  double density = 0, gValue = 0;
  double splitEntropy = 0;        ///< H(Pi), nats
  double weightedDivergence = 0;  ///< sum_t weight_t JS_t
  bool isExpanded = false;
  const double* row = nullptr;
  const double* divergences = nullptr;  ///< JS_t, nats, in the layout's order
};

/** G-tree search in a map that grows, its first half (Larsson et al., algorithm 1): from the leaves
 * up, it computes inner nodes' bookkeeping: weight, class mixture, divergences, and the G-value
 *   G_Pi(n) = max(0, sum_t weight_t JS_t(n) - alpha H(Pi_n) + sum_c Pi_c G_Pi(c)),
 * where alpha and the weights are those of AbstractionOptions. The second half, from the root down
 * along the nodes whose G-value is above 0, is CompressedTree.
 *
 * A scan recomputes the nodes above the voxels that it changed, each once, from their eight
 * children; none is adjusted, so that the order of updates leaves no trace. */
class GTree final : public NodeObserver {
 public:
  GTree(const AbstractionOptions& options, const ClassFilter<float>& filter, double resolution);

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
  std::optional<double> equalDensity(const Cell& cell) const {
    if (!unknownCounts(cell.depth + 1)) return {};
    return m_density.constantIn(cell);
  }
  const DensityField& density() const { return m_density; }
  /** The share of a cell without inner nodes. */
  double densityOf(bool isKnown, const Cell& cell) const {
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
    void recompute(NodeStore& store, Slot& inner, const Cell& cell, bool reshaped) override;
    /** Nodes in whose cell the density is not what it was. \return whether there were any */
    bool recomputeWhereChanged(NodeStore& store, Slot& slot, const Cell& cell,
                               const DensityChange& change);
    /** Calls f(node) for an inner node that is a slot, then for its octants that are inner nodes if
     * it is a block. */
    template <typename F>
    void inspect(const NodeStore& store, const Slot& inner, const Cell& cell, const F& f);

   private:
    /** What a node needs of its eight children. */
    struct Children {
      const double* rows[8];
      double gValues[8] = {}, densities[8];
      int number = 0;  ///< of those that exist
    };
    /** Note in the state whether the children's part in the compressed tree changed. */
    void noteOctants(InnerState& s) const;
    static void noteChildren(const NodeStore& store, const Slot& inner, InnerState& s);
    Children childrenOf(const NodeStore& store, const Slot& inner, const Cell& cell);
    InnerNode computeOctant(const NodeStore& store, const Slot& inner, const Cell& cell);
    /** The block's own node, and m_expandedOctants. */
    InnerNode computeBlock(const NodeStore& store, const Slot& inner, const Cell& cell);
    /** \param buffer where row and divergences go, and what computeBlock() wants to know */
    InnerNode computeOctantOfBlock(const NodeStore& store, const Block& block, int octant,
                                   const Cell& cell, double* buffer);
    InnerNode compute(const Children& children, const Cell& cell, double* buffer);
    /** Row and the like of an octant that is an inner node: kept, if it follows from its pattern.
     */
    const double* bufferOf(const NodeStore& store, const Block& block, int octant,
                           const Cell& cell);
    double* buffer(int i) { return &m_buffers[i * m_bufferSize]; }
    const double* rowOf(const ClassRecord& record);
    const double* rowOf(Units value);

    const GTree& m_gTree;
    ValueRows m_valueRows;  ///< of leaves without a class record
    RowCache<ClassRecord> m_recordRows;
    /** A buffer holds row, divergences, G-value, density, and whether it is expanded, for each of a
     * block's octants and for the node itself. */
    std::size_t m_bufferSize;
    std::vector<double> m_buffers;
    RowCache<OctantPattern> m_patterns;  ///< such buffers of octants without class records
    unsigned m_expandedOctants = 0;
    static constexpr int kOwn = 8;
  };
  Worker& worker(int i) override;

  /** Changes of the compressed tree's leaves; readers own what they read. */
  std::weak_ptr<LeafLog> leafLog;

 private:
  AbstractionOptions m_options;
  RowLayout m_layout;
  ClassFilter<float> m_filter;
  double m_resolution;
  int m_blockDepth;
  double m_eps;
  std::vector<double> m_weights;  ///< in the layout's order
  DensityField m_density;
  std::deque<Worker> m_workers;
};

template <typename F>
void GTree::Worker::inspect(const NodeStore& store, const Slot& inner, const Cell& cell,
                            const F& f) {
  if (inner.kind == Slot::Kind::Octant) return f(computeOctant(store, inner, cell));
  f(computeBlock(store, inner, cell));
  const Block& block = store.block(inner);
  for (int o = 0; o < 8; ++o)
    if (block.knownIn(o) && !block.isLeafOctant(o))
      f(computeOctantOfBlock(store, block, o, cell.child(o), buffer(kOwn)));
}

}  // namespace semantic_octree
