#pragma once
#include <semantic_abstraction/WeightsFile.h>

namespace semantic_octree {

/** All informations to be measured, each once: first the classes (0 = free space to K), then the
 * groups and whole class variables of the solutions. They all are terms of one abstraction, so that
 * another solution is a change of weights only.
 *
 * Many classes would take much memory at once: they come in batches, each of which has all terms
 * that some solution weighs. */
class TermCatalog {
 public:
  TermCatalog(const semantic_types::ClassTable& classes, const std::vector<Solution>& solutions);

  std::size_t size() const { return m_terms.size(); }
  std::size_t numClasses() const { return m_numClasses; }
  const std::string& name(std::size_t term) const { return m_terms[term].name; }

  std::size_t numBatches() const { return m_batches.size(); }
  /** Indices of a batch's terms. */
  const std::vector<std::size_t>& batch(std::size_t b) const { return m_batches[b]; }
  /** The terms themselves, with weight 0. */
  std::vector<tree_abstraction::InformationTerm> terms(std::size_t b) const;
  /** A batch's terms with the weights that a solution gives them. */
  std::vector<tree_abstraction::InformationTerm> weighedTerms(const Solution& solution,
                                                              std::size_t b) const;
  /** Weight of each term in a solution. */
  std::vector<double> allWeights(const Solution& solution) const;
  /** Weight of each of the batch's terms in a solution. */
  std::vector<double> weights(const Solution& solution, std::size_t b) const;

 private:
  std::size_t indexOf(const tree_abstraction::InformationTerm& term) const;
  void add(tree_abstraction::InformationTerm term);
  void makeBatches(const std::vector<bool>& isWeighed);

  std::size_t m_numClasses;
  std::vector<tree_abstraction::InformationTerm> m_terms;
  std::vector<std::vector<std::size_t>> m_batches;
};

}  // namespace semantic_octree
