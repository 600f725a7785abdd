#pragma once
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace labeled_cloud {

/** How often a classifier answers which class, as measured. */
class ConfusionMatrix {
 public:
  /** \param counts K x K: how often class column + 1 was answered where class row + 1 was true.
   * Rows are blended with the answers' overall frequencies, which count like one observation. So a
   * class that is hardly ever seen does not win by what little is known about it.
   * \throw std::invalid_argument it is not square, or holds a negative or no finite number, or
   * nothing but zeros. */
  explicit ConfusionMatrix(const std::vector<std::vector<double>>& counts);

  int size() const { return m_size; }
  /** K shares of the true classes among all counts, each above 0: FilterParameters::classPrior. */
  const std::vector<float>& classShares() const { return m_classShares; }
  /** K values that sum to 1, proportional to p(this class is answered | class k is true). */
  const float* given(semantic_types::ClassId answered) const {
    return &m_rows[std::size_t(answered - 1) * m_size];
  }

 private:
  int m_size;
  std::vector<float> m_rows, m_classShares;
};

/** Reads a confusion matrix from a YAML (or JSON) file:
 *
 *     classes: [road, car]           # names in the table; `fold` as in a network's configuration
 *     confusion: [[90, 10], [5, 95]] # a row for each true class, a column for each answer
 *
 * Classes that the file does not name are as good as never seen. Other keys, as whoever measured
 * may have added, are left alone. \throw std::runtime_error naming file, line and what was
 * expected. */
ConfusionMatrix loadConfusionMatrix(const std::filesystem::path& file,
                                    const semantic_types::ClassTable& table);

/** What labels say about a point's class.
 *
 * The filter knows two kinds of labels: a class that is right with the filter's `accuracy`, and a
 * row of class probabilities. This is where hard labels of which more is known become such rows. */
struct LabelModel {
  enum class Kind {
    /** Probabilities stay what they are, confidences become probabilities. */
    Soft,
    /** The likeliest class of each point is all that counts. */
    Hard
  };
  Kind kind = Kind::Soft;
  /** Labels that are less sure than this are none, [0, 1]. */
  double minConfidence = 0;
  /** The confusions of the classifier that gave the hard labels; if set, its rows are the labels.
   */
  std::shared_ptr<const ConfusionMatrix> confusion;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;

  /** Changes a cloud's labels accordingly.
   * \param confidences Per point the probability that its class is right; empty: not known.
   * \throw std::invalid_argument the confusion matrix is of another number of classes. */
  void apply(int numClasses, const std::vector<float>& confidences,
             semantic_types::LabeledCloud& cloud) const;
};
inline strict_files::Choices<LabelModel::Kind> choicesOf(LabelModel::Kind) {
  return {{"soft", LabelModel::Kind::Soft}, {"hard", LabelModel::Kind::Hard}};
}

}  // namespace labeled_cloud
