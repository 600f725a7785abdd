#pragma once
#include <cstdint>
#include <cstring>

/** \file Four doubles at once, in the compiler's own vector types: one instruction each where the
 * processor has such, several where not; the results are the same. */

// One version for every processor and one for AVX2, chosen when the library is loaded. Both give
// the same results to the last bit: multiplications and additions are never fused.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__AVX2__) && !defined(__clang__)
#define MSO_VECTORIZED __attribute__((target_clones("avx2", "default")))
#else
#define MSO_VECTORIZED
#endif

namespace semantic_octree {

using Lanes = double __attribute__((vector_size(32)));
using LaneBits = std::int64_t __attribute__((vector_size(32)));
constexpr int kNumLanes = 4;

#define MSO_ALWAYS_INLINE __attribute__((always_inline))
#define MSO_INLINE inline MSO_ALWAYS_INLINE

MSO_INLINE Lanes load(const double* p) {
  Lanes x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
MSO_INLINE void store(const Lanes& x, double* p) { std::memcpy(p, &x, sizeof x); }

/** ln x for normal x > 0, within a few units of the last place.
 *
 * x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh(s) with s = (m - 1) / (m + 1), by its
 * series. As |s| < 0.172, the first term left out is below 1e-17. */
MSO_INLINE Lanes logOf(const Lanes& x) {
  constexpr std::int64_t kOne = 0x3ff0000000000000, kSqrtHalf = 0x3fe6a09e667f3bcd;
  constexpr std::int64_t kMantissa = 0x000fffffffffffff, kTwo52 = 0x4330000000000000;
  const LaneBits bits = LaneBits(x) + (kOne - kSqrtHalf);
  // An integer below 2^52 becomes a double by writing it into the mantissa of 2^52.
  const LaneBits exponentBits = (bits >> 52) | kTwo52,
                 mantissaBits = (bits & kMantissa) + kSqrtHalf;
  const Lanes k = Lanes(exponentBits) - (4503599627370496.0 + 1023.0);
  const Lanes m = Lanes(mantissaBits);
  const Lanes f = m - 1.0, s = f / (m + 1.0), z = s * s, w = z * z;
  const Lanes odd = 1.0 / 3 + w * (1.0 / 7 + w * (1.0 / 11 + w * (1.0 / 15 + w * (1.0 / 19))));
  const Lanes even = 1.0 / 5 + w * (1.0 / 9 + w * (1.0 / 13 + w * (1.0 / 17 + w * (1.0 / 21))));
  const Lanes tail = 2.0 * s * (z * odd + w * even);
  return k * 0.693147180559945309417232121458 + (2.0 * s + tail);
}

/** x ln x, continued by 0 at x = 0. */
MSO_INLINE Lanes xLogX(const Lanes& x) {
  const Lanes tiny = {1e-300, 1e-300, 1e-300, 1e-300};
  return x * logOf(x > tiny ? x : tiny);
}

/** x, but 0 where x < 0. */
MSO_INLINE Lanes positivePart(const Lanes& x) {
  const Lanes zero = {0, 0, 0, 0};
  return x > zero ? x : zero;
}

}  // namespace semantic_octree
