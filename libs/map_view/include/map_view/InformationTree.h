#pragma once
#include <map_view/ViewCell.h>
#include <semantic_abstraction/AlphaTrees.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace map_view {

/** What each inner node of a map tells of each term, from which the compressed trees of all weights
 * and alphas follow without the map's G-values: a node is expanded while alpha is below its own.
 * Nodes are numbered parents first, in the order of children; a node's subtree follows it. */
class InformationTree {
 public:
  using Index = std::int32_t;

  /** Reads a map that keeps G-values; takes 8 bytes for each term of each inner node. The map must
   * not change afterwards, but may drop its G-values. */
  explicit InformationTree(semantic_octree::SemanticOcTree& map);

  Index size() const { return static_cast<Index>(m_end.size()); }
  /** The one behind the last node of a subtree. */
  Index end(Index node) const { return m_end[std::size_t(node)]; }
  Cube cube(Index node) const;

  /** Computes the nodes' alphas, see tree_abstraction::collapseAlphas(). \param weights one for
   * each term of the map's options */
  void setWeights(const std::vector<double>& weights);
  /** Expanded in the trees of all alphas below. */
  double alpha(Index node) const { return m_alphas[std::size_t(node)]; }
  /** Known leaves of the compressed tree. */
  std::size_t numLeaves(double alpha) const;
  /** The compressed trees of all alphas, without what their terms tell. They look at this one. */
  semantic_octree::AlphaTrees trees() const;
  /** The lowest of the nodes' finite alphas above a value; the value itself if there are none. */
  double lowestAlpha(double above) const;
  double highestAlpha() const;
  /** What the compressed tree of an alpha retains of each term, if there is something to retain:
   * see semantic_octree::AbstractionMeasures::retention(). */
  std::vector<std::optional<double>> retained(double alpha) const;

  /** By node: of what is worth telling (terms with a positive weight, times that) in its block, the
   * largest node around it that is not free, the share that the compressed tree of an alpha
   * retains. 1 where there is nothing worth telling, and above the blocks. */
  std::vector<float> retainedInBlocks(double alpha) const;

  /** Why a node that is not free pays, or does not, at an alpha: nats for each unit of p(n). */
  struct Balance {
    Index node;
    std::vector<double> divergences;  ///< JS_t(n), one for each term
    double gain;                      ///< sum_t weight_t JS_t(n)
    double splitEntropy;              ///< H(Pi_n): alpha times that is the price
    double ofChildren;                ///< sum_c Pi_c G_Pi(c)
    double gValue;                    ///< G_Pi(n) = max(0, gain - alpha H(Pi_n) + ofChildren)
  };
  /** The balances of the nodes that hold a voxel, the largest first. Visits what is below it. */
  std::vector<Balance> balancesAround(const Eigen::Array3i& key, double alpha) const;

 private:
  /** Nodes that hold a voxel and are not free, the largest first: places in m_charged. */
  std::vector<std::size_t> chargedAround(const Eigen::Array3i& key) const;
  double information(Index node, std::size_t term) const {
    return m_information[std::size_t(node) * m_numTerms + term];
  }

  std::vector<Index> m_end;
  std::vector<std::uint64_t> m_places;  ///< lowest keys and depth, packed
  std::size_t m_numTerms, m_numRoots;
  std::vector<double> m_information;  ///< node by node, its terms
  std::vector<double> m_addedLeaves, m_alphas;
  /** Of the nodes that are not free, in the same order; parents among themselves. */
  std::vector<Index> m_charged;
  std::vector<std::int32_t> m_parents;
  std::vector<double> m_shares, m_prices, m_gains;
  std::vector<double> m_weights;
};

}  // namespace map_view
