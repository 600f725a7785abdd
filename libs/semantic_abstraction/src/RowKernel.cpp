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
MSO_INLINE void mixRow(const RowSizes& sizes, double* row, double* js, const Mix& mix) {
  double* const h = row + sizes.width;
  for (int t = 0; t < sizes.binary; t += kNumLanes) {
    const Lanes p = mix(t), entropy = binaryEntropy(p);
    store(p, row + t);
    store(entropy, h + t);
    store(positivePart(entropy - mix(sizes.width + t)), js + t);
  }
  for (int i = sizes.binary; i < sizes.width; i += kNumLanes) store(mix(i), row + i);
  for (int t = sizes.binary; t < sizes.terms; t += kNumLanes) store(mix(sizes.width + t), js + t);
}

}  // namespace

MSO_VECTORIZED void mixEqualShares(const double* const children[8], const RowSizes& sizes,
                                   double* row, double* js) {
  mixRow(sizes, row, js, [children](int i) MSO_ALWAYS_INLINE { return meanOfEight(children, i); });
}

MSO_VECTORIZED void mixShares(const double* const children[8], const double shares[8],
                              const RowSizes& sizes, double* row, double* js) {
  mixRow(sizes, row, js,
         [children, shares](int i) MSO_ALWAYS_INLINE { return sumOfShares(children, shares, i); });
}

MSO_VECTORIZED void binaryEntropies(const double* p, int n, double* h) {
  for (int i = 0; i < n; i += kNumLanes) store(binaryEntropy(load(p + i)), h + i);
}

}  // namespace semantic_octree
