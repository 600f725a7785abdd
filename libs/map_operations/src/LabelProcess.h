#pragma once
#include <map>
#include <string>
#include <vector>

namespace semantic_octree {

/** Voxels by their labels: one of each scan that saw them, in the order of scans, a byte each. */
using LabeledVoxels = std::map<std::string, double>;

/** How labels of scans come about, from labels alone. A voxel has one class, which is not known. A
 * scan's label of it, after t labels of other scans, is
 *
 *   that of the scan before, with probability c,
 *   else that of any scan before, with probability r t / (1 - r + r t) (Polya's urn),
 *   else drawn from the row of the voxel's class.
 *
 * With c = r = 0 that is Dawid and Skene, "Maximum Likelihood Estimation of Observer Error-Rates
 * Using the EM Algorithm", 1979. The urn shows only as far as labels of one voxel differ.
 * Who errs again in the next scan errs for longer, too. So a label is of the urn at least as likely
 * as one of two scans repeats the one before, r >= 1 - (1 - c)^2. */
class LabelProcess {
 public:
  /** \param numClasses K > 1
   * \param accuracy, labelsBefore Beside what was seen, so many labels of each class are right
   * with this probability, (1/K, 1). \param labelsAtFirst if more, in the first half of the search.
   * Where labels are wrong often, that keeps classes from being taken for each other. */
  LabelProcess(const LabeledVoxels& voxels, int numClasses, double accuracy, double labelsBefore,
               double labelsAtFirst = 0);

  /** 1 - (1 - c)^2: that one of two scans repeats the one before. */
  double leastCorrelation() const { return 1 - (1 - m_repeated) * (1 - m_repeated); }
  /** c, [0, 1): of three labels in succession, the first two of which differ, how much more often
   * the third is the second than the first. */
  double repeated() const { return m_repeated; }
  /** r, [1 - (1 - c)^2, 1) */
  double correlation() const { return m_correlation; }
  /** K x K expected counts of labels that were drawn: row is the true class. */
  const std::vector<std::vector<double>>& counts() const { return m_counts; }
  /** p(class k + 1), given a voxel's labels. */
  std::vector<double> classesOf(const std::string& labels) const;
  /** Voxels may be wrong in all scans alike.
   * \param always how often, as a multiple of how often in one scan, [0, 1] */
  void setAlwaysWrong(double always);

 private:
  using Table = std::vector<std::vector<double>>;
  /** Probabilities of a label, given the voxel's class: that it was drawn, or is of the urn. */
  struct Origin {
    double drawn, urn;
  };
  /** \param origins of each label and class */
  std::vector<double> looksOf(const std::string& labels, std::vector<Origin>* origins) const;
  /** Share of the draws among labels that do not repeat the one before. */
  double shareDrawn(std::size_t earlier) const;
  /** \return the sign of d ln p(all labels) / dr */
  double step(const LabeledVoxels& voxels, const Table& before);

  double m_repeated, m_correlation;
  Table m_counts, m_rows;
  std::vector<double> m_shares;
  Table m_given;  ///< row: the class that a voxel looks like, column: what it is; empty: the same
};

}  // namespace semantic_octree
