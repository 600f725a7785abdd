#pragma once
#include <semantic_octree/ClassFilter.h>

#include <deque>

#include "Cell.h"
#include "DensityField.h"
#include "NodeStore.h"
#include "RowLayout.h"

namespace semantic_octree {

/** Bookkeeping of an inner node. Behind it stand the node's row (see RowLayout) and the terms'
 * divergences. All of it is a function of the children alone. */
struct InnerState {
  double density;       ///< mean density of p(x) in the cell; p(n) = density * volume, unnormalized
  double gValue;        ///< G_Pi; above the blocks, if they are free, the mean of the children's
  double splitEntropy;  ///< H(Pi), nats
  std::uint16_t childKinds;   ///< two bits each: no child, a leaf, an inner node
  std::uint8_t isExpanded;    ///< in the compressed tree if the parent is
  std::uint8_t changedBelow;  ///< the compressed tree's leaves may have changed since last told

  double* row() { return reinterpret_cast<double*>(this + 1); }
  const double* row() const { return reinterpret_cast<const double*>(this + 1); }
};

/** G-tree search in a map that grows, its first half (Larsson et al., algorithm 1): from the leaves
 * up, it computes inner nodes' bookkeeping: weight, class mixture, divergences, and the G-value
 *   G_Pi(n) = max(0, sum_t weight_t JS_t(n) - alpha H(Pi_n) + sum_c Pi_c G_Pi(c)),
 * where alpha and the weights are those of AbstractionOptions. The second half, from the root down
 * along the nodes whose G-value is above 0, is CompressedTree.
 *
 * A scan recomputes the nodes above the voxels that it changed, each once, from their eight
 * children; none is adjusted, so that the order of updates leaves no trace. */
class GTree {
 public:
  GTree(const AbstractionOptions& options, const ClassFilter<float>& filter, double resolution);

  const AbstractionOptions& options() const { return m_options; }
  const RowLayout& layout() const { return m_layout; }
  std::size_t stateBytes() const;
  double* divergences(InnerState& s) const { return s.row() + m_layout.rowSize(); }
  const double* divergences(const InnerState& s) const { return s.row() + m_layout.rowSize(); }

  /** Depth of the blocks' nodes: at this depth and below, unknown space has weight. */
  int blockDepth() const { return m_blockDepth; }
  /** Above the blocks, and free of charge. */
  bool isFreeFrame(int depth) const {
    return depth < m_blockDepth && m_options.frame == AbstractionOptions::Frame::Free;
  }

  /** Weight of unknown space at a depth relative to known space. */
  double missingDensity(int depth) const {
    return depth > m_blockDepth ? m_options.unknownWeight : 0.0;
  }
  /** All eight children of a node at this depth weigh the same, known or not. */
  bool hasEqualShares(int depth) const {
    return m_density.isUniform() && missingDensity(depth + 1) == 1.0;
  }
  const DensityField& density() const { return m_density; }

  /** New weights of the same terms, and alpha. What is kept of nodes is then out of date in its
   * G-values only: see reweigh(). */
  void setWeights(const std::vector<double>& termWeights, double alpha);
  void setRegions(std::vector<Region> regions, double resolution);

  /** sum_t weight_t JS_t of a node. */
  double weightedDivergence(const InnerState& s) const;
  /** Sets the G-value from divergences, split entropy and the mean of the children's G-values. */
  void settleG(InnerState& s, int depth, double childrensG) const;

  /** One thread's part: buffers, and rows of frequent values. */
  class Worker {
   public:
    explicit Worker(const GTree& gTree);
    void recompute(NodeStore& store, Node& inner, const Cell& cell);
    /** A node and all inner nodes below. */
    void recomputeAll(NodeStore& store, Node& node, const Cell& cell);
    /** Nodes in whose cell the density is not what it was. \return whether there were any */
    bool recomputeWhereChanged(NodeStore& store, Node& node, const Cell& cell,
                               const DensityField& before);
    /** G-values only, of a node and all inner nodes below, from what is kept. */
    void reweigh(NodeStore& store, Node& inner, const Cell& cell);

   private:
    /** Also notes in the state whether children came, went or changed. */
    void gatherRows(const NodeStore& store, const Node& inner, const double** rows,
                    double* gValues);
    void gatherDensities(const NodeStore& store, const Node& inner, const Cell& cell,
                         double* densities) const;
    void reweighChildren(NodeStore& store, Node& inner, const Cell& cell, double* gValues);
    const double* rowOf(const NodeStore& store, const Node& leaf);

    const GTree& m_gTree;
    RowCache<float> m_uniformRows;  ///< of leaves without a class record, by their values
    RowCache<Belief> m_recordRows;
  };
  /** The i-th thread's; made when first asked for (not thread safe). */
  Worker& worker(int i);

 private:
  AbstractionOptions m_options;
  RowLayout m_layout;
  ClassFilter<float> m_filter;
  int m_blockDepth;
  double m_eps;
  std::vector<double> m_weights;  ///< in the layout's order
  DensityField m_density;
  std::deque<Worker> m_workers;
};

}  // namespace semantic_octree
