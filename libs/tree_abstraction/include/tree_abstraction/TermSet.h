#pragma once
#include <cstddef>
#include <vector>

#include "tree_abstraction/AbstractionWeights.h"
#include "tree_abstraction/Divergence.h"

namespace tree_abstraction {

/** The terms' outcome probabilities as one row of doubles per tree node, and what is computed on
 * rows.
 *
 * A row holds each term's probabilities one after the other. A yes-or-no term (one group and a
 * rest) takes one double, the group's probability; any other term takes one double per outcome, its
 * rest last. Rows mix linearly: the parent's row is the mixture of its children's, see mixRows().
 */
class TermSet {
 public:
  /** Where a term's probabilities stand in a row. */
  struct Slot {
    std::size_t offset, width;
    bool isBinary() const { return width == 1; }
  };

  /** The probability of a class is added to row[entry]. */
  struct Contribution {
    std::size_t classId, entry;
  };

  /** \throw std::invalid_argument as AbstractionWeights::validate(). */
  TermSet(const AbstractionWeights& weights, int numClasses);

  int numClasses() const { return m_numClasses; }
  /** Number of terms. */
  std::size_t size() const { return m_slots.size(); }
  /** Number of doubles in a row. */
  std::size_t width() const { return m_width; }
  Slot slot(std::size_t term) const { return m_slots[term]; }

  /** What a row is made of, by ascending entry; for callers whose distributions are not dense. */
  const std::vector<Contribution>& contributions() const { return m_contributions; }

  /** Row of a node whose classes 0..K have these K + 1 probabilities. */
  void project(const double* distribution, double* row) const;

  /** Entropy of a term's variable in a row, in nats. */
  double entropy(std::size_t term, const double* row) const {
    const auto [offset, count] = m_slots[term];
    return count == 1 ? binaryEntropy(row[offset]) : tree_abstraction::entropy(row + offset, count);
  }

  /** Stable JS of a term among n children with shares pi, whose rows follow one another. */
  double divergence(std::size_t term, const double* pi, const double* rows, std::size_t n) const {
    const auto [offset, count] = m_slots[term];
    return count == 1 ? binaryJensenShannon(pi, rows + offset, n, m_width)
                      : jensenShannon(pi, rows + offset, n, count, m_width);
  }

 private:
  int m_numClasses;
  std::size_t m_width = 0;
  std::vector<Slot> m_slots;
  std::vector<Contribution> m_contributions;
};

}  // namespace tree_abstraction
