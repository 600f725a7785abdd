#pragma once
#include <semantic_octree/AbstractionOptions.h>
#include <tree_abstraction/TermSet.h>

#include <vector>

#include "AbstractionKernel.h"
#include "NodeStore.h"

namespace semantic_octree {

/** How a node's class distribution becomes a row of outcome probabilities and entropies (see
 * RowSizes), and what the row of unknown space is. */
class RowLayout {
 public:
  RowLayout(const AbstractionOptions& options, int numClasses);

  const RowSizes& sizes() const { return m_sizes; }
  /** Doubles of a row: probabilities and entropies. */
  int rowSize() const { return m_sizes.row(); }
  int numTerms() const { return static_cast<int>(m_order.size()); }
  /** Where term t of the options stands among the entropies and divergences. */
  int positionOf(int term) const { return m_order[term]; }

  /** Row of a cell. */
  void rowOf(const Belief& belief, double* row) const;
  const double* unknownRow() const { return m_unknownRow.data(); }
  /** Row and divergences of a node from its children's rows and shares (null: each is 1/8). */
  void mix(const double* const children[8], const double* shares, double* row, double* js) const;

 private:
  /** Entry of a row = p(free) * free + number of classes * p(rest) + what named classes exceed it
   * by. */
  struct Entry {
    double free = 0, classes = 0;
  };
  struct WideTerm {
    int position, first, width;
  };
  /** Fills in the entropies behind the probabilities. */
  void fillEntropies(double* row) const;
  void fillWideEntropies(double* row) const;
  void addTerm(const tree_abstraction::TermSet& terms, std::size_t term, int firstEntry);

  int m_numClasses;
  RowSizes m_sizes;
  std::vector<int> m_order;
  std::vector<Entry> m_entries;
  std::vector<std::vector<int>> m_entriesOfClass;
  std::vector<WideTerm> m_wideTerms;
  std::vector<double> m_unknownRow;
};

}  // namespace semantic_octree
