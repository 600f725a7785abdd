#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_abstraction/AlphaTrees.h>
#include <semantic_octree/Cube.h>
#include <semantic_octree/SemanticOcTreeNode.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace map_view {

using semantic_octree::AbstractionOptions;
using semantic_octree::Cube;
using semantic_octree::SemanticOcTree;

/** A cube of a map as a view shows it. */
struct ViewCell : Cube {
  /** What it shows: the node for the cube or for a larger one around it. If the cube stands for
   * finer cells, it is one of these, from its upper half if there is one. None: unknown space. */
  semantic_octree::SemanticOcTreeNode node;
  /** Tells inner nodes of the map apart; 0 for leaves. */
  std::uint64_t innerNode = 0;
  /** In a compressed tree, LiveCompression's number of the inner node: the cube's, or the smallest
   * one around it. */
  std::int32_t around = 0;

  bool isOccupied() const { return node && node.getLogOdds() > 0; }
};

/** A box of voxels: keys, both ends included. */
struct KeyBox {
  Eigen::Array3i low, high;
  static KeyBox everything() {
    return {Eigen::Array3i::Zero(), Eigen::Array3i::Constant(semantic_octree::kNumKeys - 1)};
  }
  static KeyBox of(const Cube& cube) { return {cube.lowest, cube.lowest + (cube.edge() - 1)}; }
  bool meets(const Cube& cube) const {
    return (cube.lowest <= high).all() && (cube.lowest + cube.edge() > low).all();
  }
  bool contains(const Cube& cube) const {
    return (cube.lowest >= low).all() && (cube.lowest + cube.edge() - 1 <= high).all();
  }
};

/** The compressed tree of a map whose weights and alpha change all the time. Its leaves are those
 * of semantic-map-compress with solution(); a leaf of the map that reaches above the blocks stays
 * one.
 *
 * It knows what each inner node of the map tells of each term. The compressed trees of all weights
 * and alphas follow from that, without the map's G-values: a node is expanded while alpha is below
 * its own. Nodes are numbered parents first, in the order of children; a node's subtree follows it.
 */
class LiveCompression {
 public:
  using Index = std::int32_t;

  /** Each class that the map has, free space and what the solution weighs become terms; each takes
   * 8 bytes for each inner node. The map must not change any more, and keeps no G-values.
   * \throw std::invalid_argument bad options, or an empty map. */
  LiveCompression(SemanticOcTree& map, const AbstractionOptions& solution);

  /** All classes that occur in a map, each with weight 1. \param options all but the weights */
  static AbstractionOptions allClasses(const SemanticOcTree& map, AbstractionOptions options = {});

  std::size_t numTerms() const { return terms().size(); }
  const std::string& name(std::size_t term) const { return terms()[term].name; }
  /** A whole class variable has no negative weight in files. */
  bool mayBeIrrelevant(std::size_t term) const { return terms()[term].groups.size() == 1; }
  double weight(std::size_t term) const { return terms()[term].weight; }
  double alpha() const { return m_options.weights.alpha; }

  /** \throw std::invalid_argument a class would be relevant and irrelevant; all stays as it was. */
  void setWeight(std::size_t term, double weight);
  /** \throw std::invalid_argument below 0 or not finite. */
  void setAlpha(double alpha);
  /** Alpha becomes that of the largest compressed tree with at most that many leaves, or of the
   * smallest one. */
  void setLeaves(std::size_t wanted);
  /** Alpha becomes that of the largest compressed tree whose file has at most that many bytes, or
   * of the smallest one. Takes some twenty times what compressedMap() takes. \param map the one it
   * was made of */
  void setBytes(const SemanticOcTree& map, std::size_t wanted);
  /** The compressed tree as a map of its own: see semantic_octree::compressedMap(). */
  SemanticOcTree compressedMap(const SemanticOcTree& map) const;

  /** Between these the tree changes with alpha. */
  double lowestAlpha() const;
  double highestAlpha() const;
  /** Known leaves of the compressed tree. */
  std::size_t numLeaves() const;
  /** What the compressed tree retains of each term, if there is something to retain: see
   * semantic_octree::AbstractionMeasures::retention(). */
  std::vector<std::optional<double>> retained() const;
  /** The share that the compressed tree retains of what is worth telling in an inner node's block.
   * Worth telling are terms with a positive weight, times that; the block is the largest node
   * around it that is not free. 1 where nothing is worth telling, and above the blocks. */
  float retainedAround(Index node) const;

  /** The map's inner nodes. */
  Index size() const { return static_cast<Index>(m_end.size()); }
  /** Number of the node behind the last one of a subtree. */
  Index end(Index node) const { return m_end[std::size_t(node)]; }
  Cube cube(Index node) const;
  /** The node is expanded in the trees of all alphas below: see tree_abstraction::collapseAlphas().
   */
  double alphaOf(Index node) const { return m_alphas[std::size_t(node)]; }
  bool isExpanded(Index node) const { return alphaOf(node) > m_threshold; }

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
  std::vector<Balance> balancesAround(const Eigen::Array3i& key) const;
  /** Cubes in which leaves came and went since the last call; at first: all. */
  std::vector<KeyBox> takeChange();

  /** Without the terms that have no weight. */
  AbstractionOptions solution() const;

 private:
  const std::vector<tree_abstraction::InformationTerm>& terms() const {
    return m_options.weights.terms;
  }
  void readNodes(SemanticOcTree& map);
  /** \throw std::invalid_argument they contradict each other; all stays as it was. */
  void change(const tree_abstraction::AbstractionWeights& weights);
  void findAlphas();
  /** The compressed trees of all alphas, without what their terms tell. They look at this one. */
  semantic_octree::AlphaTrees trees() const;
  std::vector<float> retainedInBlocks() const;
  /** Nodes that hold a voxel and are not free, the largest first: places in m_charged. */
  std::vector<std::size_t> chargedAround(const Eigen::Array3i& key) const;
  double information(Index node, std::size_t term) const {
    return m_information[std::size_t(node) * numTerms() + term];
  }

  semantic_types::ClassTable m_classes;
  AbstractionOptions m_options;
  std::vector<Index> m_end;
  std::vector<std::uint64_t> m_places;  ///< lowest keys and depth, packed
  std::size_t m_numRoots;
  std::vector<double> m_information;  ///< node by node, its terms
  std::vector<double> m_addedLeaves, m_alphas;
  /** The nodes that are not free, in the same order, and their parents among them. */
  std::vector<Index> m_charged;
  std::vector<std::int32_t> m_parents;
  std::vector<double> m_shares, m_prices, m_gains;
  double m_threshold = 0;                 ///< alpha, and what counts as a tie
  mutable std::vector<float> m_retained;  ///< in blocks, by node; empty: not asked for yet
  std::vector<char> m_toldExpanded;       ///< by node; empty: nothing was told
};

/** A solution as loadWeights() reads it, to the last bit of its numbers; terms without weight are
 * left out.
 * \throw std::invalid_argument nothing has a weight, or a term is none that files have. */
std::string weightsText(const AbstractionOptions& solution,
                        const semantic_types::ClassTable& classes);

}  // namespace map_view
