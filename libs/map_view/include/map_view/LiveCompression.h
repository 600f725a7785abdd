#pragma once
#include <map_view/InformationTree.h>
#include <semantic_abstraction/TermCatalog.h>

#include <optional>
#include <string>
#include <vector>

namespace map_view {

using semantic_octree::AbstractionOptions;
using semantic_octree::SemanticOcTree;
using semantic_octree::Solution;

/** The compressed tree of a map whose weights and alpha change all the time. Its leaves are those
 * of semantic-map-compress with solution(); a leaf of the map that reaches above the blocks stays
 * one. */
class LiveCompression {
 public:
  /** Each class that the map has, free space and what the solution weighs become terms. The map
   * must not change any more, and keeps no G-values. \throw std::invalid_argument bad options, or
   * an empty map. */
  LiveCompression(SemanticOcTree& map, const Solution& solution, const AbstractionOptions& space);

  /** All classes that occur in a map, each with weight 1. */
  static Solution allClasses(const SemanticOcTree& map);

  std::size_t numTerms() const { return terms().size(); }
  const std::string& name(std::size_t term) const { return terms()[term].name; }
  /** A whole class variable has no negative weight in files. */
  bool mayBeIrrelevant(std::size_t term) const { return terms()[term].groups.size() == 1; }
  double weight(std::size_t term) const { return terms()[term].weight; }
  double alpha() const { return m_weights.alpha; }

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
  std::size_t numLeaves() const { return m_tree.numLeaves(m_threshold); }
  /** Share of each term's information that the compressed tree keeps. */
  std::vector<std::optional<double>> retained() const { return m_tree.retained(m_threshold); }

  /** The share of what is worth telling in an inner node's block that the compressed tree keeps:
   * see InformationTree::retainedInBlocks(). */
  float retainedAround(InformationTree::Index node) const;

  /** The map's inner nodes. */
  const InformationTree& tree() const { return m_tree; }
  /** Why the tree expands those that hold a voxel, or does not: see
   * InformationTree::balancesAround(). */
  std::vector<InformationTree::Balance> balancesAround(const Eigen::Array3i& key) const {
    return m_tree.balancesAround(key, alpha());
  }
  bool isExpanded(InformationTree::Index node) const { return m_tree.alpha(node) > m_threshold; }
  /** Cubes in which leaves came and went since the last call; at first: all. */
  std::vector<KeyBox> takeChange();

  /** Terms with a weight, and alpha. */
  Solution solution() const;
  const AbstractionOptions& space() const { return m_space; }

 private:
  const std::vector<tree_abstraction::InformationTerm>& terms() const { return m_weights.terms; }
  /** \throw std::invalid_argument they contradict each other; all stays as it was. */
  void change(const tree_abstraction::AbstractionWeights& weights);
  void findAlphas();

  int m_numClasses;
  AbstractionOptions m_space;
  std::string m_name;
  tree_abstraction::AbstractionWeights m_weights;
  InformationTree m_tree;
  double m_threshold = 0;                 ///< alpha, and what counts as a tie
  mutable std::vector<float> m_retained;  ///< in blocks, by node; empty: not asked for yet
  std::vector<char> m_toldExpanded;       ///< by node; empty: nothing was told
};

}  // namespace map_view
