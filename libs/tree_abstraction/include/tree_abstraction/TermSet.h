#pragma once
#include <tree_abstraction/AbstractionWeights.h>

#include <cstddef>
#include <vector>

namespace tree_abstraction {

/** How the terms' outcome probabilities stand in one row of doubles per tree node.
 *
 * A row holds each term's probabilities one after the other. A yes-or-no term (one group and a
 * rest) takes one double, the group's probability; any other term takes one double per outcome, its
 * rest last. Rows mix linearly: the parent's row is the mixture of its children's. */
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

  /** What a row is made of, by ascending entry. */
  const std::vector<Contribution>& contributions() const { return m_contributions; }

 private:
  int m_numClasses;
  std::size_t m_width = 0;
  std::vector<Slot> m_slots;
  std::vector<Contribution> m_contributions;
};

}  // namespace tree_abstraction
