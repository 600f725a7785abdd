#pragma once
#include <semantic_octree/store/ClassRecord.h>

namespace semantic_octree {

/** Sizes of the rows that the abstraction keeps per node, in doubles, padded to whole vectors.
 *
 * A row holds the probabilities of the terms' outcomes: first those of yes-or-no terms (one each),
 * then those of terms with more outcomes. Behind it stand the terms' entropies in the same order:
 * `probabilities[width] | entropies[terms]`. An inner node appends its divergences. */
struct RowSizes {
  static constexpr int kLanes = 4;
  static constexpr int pad(int n) { return (n + kLanes - 1) / kLanes * kLanes; }
  int width = 0;   ///< padded number of probabilities
  int terms = 0;   ///< padded number of terms
  int binary = 0;  ///< padded number of yes-or-no terms

  int row() const { return width + terms; }
};

/** The row of a node from its eight children's, probabilities and entropies of yes-or-no terms, and
 * all divergences (of terms with more outcomes: so far the mean of the children's entropies).
 * \return the weighted sum of yes-or-no terms' divergences */
double mixEqualShares(const double* const children[8], const RowSizes& sizes, const double* weights,
                      double* row, double* js);
double mixShares(const double* const children[8], const double shares[8], const RowSizes& sizes,
                 const double* weights, double* row, double* js);

/** Entropies of yes-or-no variables, nats; n a multiple of RowSizes::kLanes. */
void binaryEntropies(const double* p, int n, double* h);

/** Sorts 64 values eight by eight, in ascending order. */
void sortOctants(const Units* values, Units* sorted);

}  // namespace semantic_octree
