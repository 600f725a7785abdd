#pragma once
#include <cstdint>
#include <vector>

namespace semantic_octree {

/** What n labels of one scan in one cell say of the class that they name, as against a class that
 * none of them names: the log-likelihood ratio
 *
 *   f(n) = sum_{i < n} ln((s accuracy + i) / (s e + i)),  e = (1 - accuracy) / (K - 1),
 *
 * of Dirichlet-multinomial labels (Polya's urn: Minka, "Estimating a Dirichlet distribution"). In a
 * cell of class k the first label is k with probability accuracy, and any other class with e. Two
 * labels are correlated by 1 / (1 + s) = labelCorrelation. Without correlation each label adds as
 * much as the first (counting), with 1 only the first does.
 *
 * What counts of other classes add is the same for all classes. */
class LabelEvidence {
 public:
  /** \param accuracy above 1 / numClasses, below 1 \param numClasses K > 1
   * \param correlation 0 to 1; what is below 1e-9 counts as that */
  LabelEvidence(double accuracy, int numClasses, double correlation);
  /** f(n) */
  double operator()(std::uint32_t n) const { return n < m_ofFew.size() ? m_ofFew[n] : ofMany(n); }

 private:
  double ofMany(double n) const;

  double m_right, m_wrong;      ///< s accuracy, s e
  std::vector<double> m_ofFew;  ///< by n
  double m_atMany = 0;          ///< f(n) less what ofMany() computes anew
};

}  // namespace semantic_octree
