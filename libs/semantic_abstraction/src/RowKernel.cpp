#include "RowKernel.h"

#include <semantic_octree/store/Lanes.h>

namespace semantic_octree {
namespace {

static_assert(RowSizes::kLanes == kNumLanes, "rows are padded to whole vectors");

/** Mean of the children's values from i on; eight equal ones give exactly that value. */
MSO_INLINE Lanes meanOfEight(const double* const c[8], int i) {
  return (((load(c[0] + i) + load(c[1] + i)) + (load(c[2] + i) + load(c[3] + i))) +
          ((load(c[4] + i) + load(c[5] + i)) + (load(c[6] + i) + load(c[7] + i)))) *
         0.125;
}

MSO_INLINE Lanes sumOfShares(const double* const c[8], const double s[8], int i) {
  return ((s[0] * load(c[0] + i) + s[1] * load(c[1] + i)) +
          (s[2] * load(c[2] + i) + s[3] * load(c[3] + i))) +
         ((s[4] * load(c[4] + i) + s[5] * load(c[5] + i)) +
          (s[6] * load(c[6] + i) + s[7] * load(c[7] + i)));
}

MSO_INLINE Lanes binaryEntropy(const Lanes& p) { return 0.0 - xLogX(p) - xLogX(1.0 - p); }

/** \param mix gives the mixture of the children's values from an index on */
template <typename Mix>
MSO_INLINE double mixRow(const RowSizes& sizes, const double* weights, double* row, double* js,
                         const Mix& mix) {
  double* const h = row + sizes.width;
  Lanes weighted = {};
  for (int t = 0; t < sizes.binary; t += kNumLanes) {
    const Lanes p = mix(t), entropy = binaryEntropy(p);
    store(p, row + t);
    store(entropy, h + t);
    const Lanes divergence = positivePart(entropy - mix(sizes.width + t));
    store(divergence, js + t);
    weighted += load(weights + t) * divergence;
  }
  for (int i = sizes.binary; i < sizes.width; i += kNumLanes) store(mix(i), row + i);
  for (int t = sizes.binary; t < sizes.terms; t += kNumLanes) store(mix(sizes.width + t), js + t);
  return (weighted[0] + weighted[1]) + (weighted[2] + weighted[3]);
}

/** A value of each octant. */
using UnitVector = Units __attribute__((vector_size(16)));

/** Rows become columns. */
MSO_INLINE void transpose(UnitVector (&v)[8]) {
  // Twice eight values become one row of pairs; after three times, 8 x 8 are transposed.
  for (int step = 0; step < 3; ++step) {
    UnitVector w[8];
    for (int i = 0; i < 4; ++i) {
      w[2 * i] = __builtin_shufflevector(v[i], v[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
      w[2 * i + 1] = __builtin_shufflevector(v[i], v[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; ++i) v[i] = w[i];
  }
}

}  // namespace

MSO_VECTORIZED void sortOctants(const Units* values, Units* sorted) {
  // A sorting network of 19 comparisons; each is of all octants at once.
  static constexpr int kCompared[19][2] = {{0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6},
                                           {3, 7}, {0, 1}, {2, 3}, {4, 5}, {6, 7}, {2, 4}, {3, 5},
                                           {1, 4}, {3, 6}, {1, 2}, {3, 4}, {5, 6}};
  UnitVector v[8];
  std::memcpy(v, values, sizeof v);
  transpose(v);
  for (const auto& [i, j] : kCompared) {
    const UnitVector low = v[i] < v[j] ? v[i] : v[j];
    v[j] = v[i] < v[j] ? v[j] : v[i];
    v[i] = low;
  }
  transpose(v);
  std::memcpy(sorted, v, sizeof v);
}

MSO_VECTORIZED double mixEqualShares(const double* const children[8], const RowSizes& sizes,
                                     const double* weights, double* row, double* js) {
  return mixRow(sizes, weights, row, js,
                [children](int i) MSO_ALWAYS_INLINE { return meanOfEight(children, i); });
}

MSO_VECTORIZED double mixShares(const double* const children[8], const double shares[8],
                                const RowSizes& sizes, const double* weights, double* row,
                                double* js) {
  return mixRow(sizes, weights, row, js, [children, shares](int i) MSO_ALWAYS_INLINE {
    return sumOfShares(children, shares, i);
  });
}

MSO_VECTORIZED void binaryEntropies(const double* p, int n, double* h) {
  for (int i = 0; i < n; i += kNumLanes) store(binaryEntropy(load(p + i)), h + i);
}

}  // namespace semantic_octree
