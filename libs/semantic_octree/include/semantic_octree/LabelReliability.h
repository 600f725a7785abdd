#pragma once
#include <semantic_octree/FilterParameters.h>
#include <semantic_types/ClassTable.h>

namespace semantic_octree {

/** How far the labels of one scan are trusted. */
struct LabelReliability {
  double accuracy;     ///< as FilterParameters::accuracy
  double correlation;  ///< as FilterParameters::labelCorrelation

  bool operator==(const LabelReliability& o) const {
    return accuracy == o.accuracy && correlation == o.correlation;
  }
};

/** How often two labels of one scan in one cell are the same. In a cell of class k, labels that are
 * right with probability `accuracy` and correlated by r agree with probability
 *
 *   S + r (1 - S),   S = accuracy^2 + (1 - accuracy)^2 / (K - 1),
 *
 * Agreement tells r (the moment estimate of an intraclass correlation: Fleiss, "Measuring Nominal
 * Scale Agreement among Many Raters", 1971). Below S it tells that the accuracy is lower. */
class LabelAgreement {
 public:
  /** The labels of one cell. \param begin, end in ascending order */
  void add(const semantic_types::ClassId* begin, const semantic_types::ClassId* end);

  /** The largest correlation and accuracy, up to the parameters', with which labels would agree as
   * these did. Where they agree less than with a correlation of 0.02, the accuracy that leads to
   * that. Agreement is taken in steps of 1/64, so that scans that are alike are trusted alike, and
   * the parameters count like another thousand labels.
   * \param numClasses K; with one, the answer is the parameters' */
  LabelReliability explain(const FilterParameters& parameters, int numClasses) const;

 private:
  double m_labels = 0;    ///< in cells with several
  double m_agreeing = 0;  ///< sum over them of the share of their cell's others that are the same
};

}  // namespace semantic_octree
