#include "AbstractionKernel.h"

#include "FastLog.h"

// One version for every processor and one for AVX2, chosen when the library is loaded. Both give
// the same results to the last bit: multiplications and additions are never fused.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__AVX2__) && !defined(__clang__)
#define MSO_VECTORIZED __attribute__((target_clones("avx2", "default")))
#else
#define MSO_VECTORIZED
#endif

namespace semantic_octree {

MSO_VECTORIZED void meanOfEight(const double* const children[8], int size, double* __restrict mix) {
  const double *a = children[0], *b = children[1], *c = children[2], *d = children[3];
  const double *e = children[4], *f = children[5], *g = children[6], *h = children[7];
  for (int i = 0; i < size; ++i)
    mix[i] = (((a[i] + b[i]) + (c[i] + d[i])) + ((e[i] + f[i]) + (g[i] + h[i]))) * 0.125;
}

MSO_VECTORIZED void weightedMean(const double* const children[8], const double shares[8], int size,
                                 double* __restrict mix) {
  for (int i = 0; i < size; ++i) {
    const auto part = [&](int c) { return shares[c] * children[c][i]; };
    mix[i] =
        ((part(0) + part(1)) + (part(2) + part(3))) + ((part(4) + part(5)) + (part(6) + part(7)));
  }
}

MSO_VECTORIZED void binaryEntropies(const double* p, int n, double* __restrict h) {
  for (int i = 0; i < n; ++i) h[i] = 0.0 - fastXLogX(p[i]) - fastXLogX(1.0 - p[i]);
}

}  // namespace semantic_octree
