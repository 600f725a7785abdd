#pragma once
#include <semantic_octree/Abstraction.h>
#include <semantic_octree/TermCatalog.h>

#include <optional>
#include <string>
#include <vector>

namespace map_view {

using semantic_octree::AbstractionOptions;
using semantic_octree::SemanticOcTree;
using semantic_octree::Solution;

/** The compressed tree of a map whose weights and alpha change all the time. Its leaves are those
 * of semantic-map-compress with solution(). */
class LiveCompression {
 public:
  /** Each class that the map has, free space and what the solution weighs become terms; the map
   * keeps G-values from now on. \throw std::invalid_argument bad options, or an empty map. */
  LiveCompression(SemanticOcTree& map, const Solution& solution, const AbstractionOptions& space);

  /** All classes that occur in a map, each with weight 1. */
  static Solution allClasses(const SemanticOcTree& map);

  std::size_t numTerms() const { return m_terms.size(); }
  const std::string& name(std::size_t term) const { return m_terms[term].name; }
  /** A whole class variable has no negative weight in files. */
  bool mayBeIrrelevant(std::size_t term) const { return m_terms[term].groups.size() == 1; }
  double weight(std::size_t term) const { return m_terms[term].weight; }
  double alpha() const { return m_alpha; }

  /** \throw std::invalid_argument a class would be relevant and irrelevant; all stays as it was. */
  void setWeight(std::size_t term, double weight);
  /** \throw std::invalid_argument below 0 or not finite. */
  void setAlpha(double alpha);
  /** Alpha becomes that of the largest compressed tree with at most that many leaves, or of the
   * smallest one. */
  void setLeaves(std::size_t wanted);

  /** Between these the tree changes with alpha. */
  double lowestAlpha() const;
  double highestAlpha() const;
  /** Known leaves of the compressed tree; takes no time. */
  std::size_t numLeaves() const;
  /** Share of a term's information that the compressed tree keeps, and the rest. */
  const semantic_octree::AbstractionMeasures& measures() const;
  /** Leaves that came and went since the last call. */
  semantic_octree::TreeChange takeChange() { return m_abstraction.takeChange(); }

  /** Terms with a weight, and alpha. */
  Solution solution() const;
  const AbstractionOptions& space() const { return m_space; }

 private:
  static std::vector<tree_abstraction::InformationTerm> termsOf(SemanticOcTree& map,
                                                                const Solution& solution,
                                                                const AbstractionOptions& space);
  std::vector<double> weights() const;
  void findPath();

  SemanticOcTree& m_map;
  AbstractionOptions m_space;
  double m_alpha;
  std::string m_name;
  std::vector<tree_abstraction::InformationTerm> m_terms;  ///< with their weights
  semantic_octree::Abstraction m_abstraction;
  std::optional<semantic_octree::Abstraction::Path> m_path;
  std::vector<double> m_leavesOfTree;
  mutable std::optional<semantic_octree::AbstractionMeasures> m_measures;
};

}  // namespace map_view
