#pragma once
#include <cstdint>
#include <cstring>

namespace semantic_octree {

/** ln x for normal x > 0, within a few units of the last place; straight-line code that compilers
 * turn into vector instructions.
 *
 * x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh(s) with s = (m - 1) / (m + 1), by its
 * series: |s| < 0.172, so that the first term left out is below 1e-17. */
inline double fastLog(double x) {
  constexpr std::uint64_t kOne = 0x3ff0000000000000, kSqrtHalf = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t kMantissa = 0x000fffffffffffff, kTwo52 = 0x4330000000000000;
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof x);
  bits += kOne - kSqrtHalf;
  // An integer below 2^52 becomes a double by writing it into the mantissa of 2^52.
  const std::uint64_t exponentBits = (bits >> 52) | kTwo52,
                      mantissaBits = (bits & kMantissa) + kSqrtHalf;
  double k, m;
  std::memcpy(&k, &exponentBits, sizeof k);
  std::memcpy(&m, &mantissaBits, sizeof m);
  k -= 4503599627370496.0 + 1023.0;
  const double f = m - 1.0, s = f / (m + 1.0), z = s * s, w = z * z;
  const double odd = 1.0 / 3 + w * (1.0 / 7 + w * (1.0 / 11 + w * (1.0 / 15 + w * (1.0 / 19))));
  const double even = 1.0 / 5 + w * (1.0 / 9 + w * (1.0 / 13 + w * (1.0 / 17 + w * (1.0 / 21))));
  const double tail = 2.0 * s * (z * odd + w * even);
  return k * 0.693147180559945309417232121458 + (2.0 * s + tail);
}

/** x ln x, continued by 0 at x = 0. */
inline double fastXLogX(double x) {
  constexpr double kTiny = 1e-300;
  return x * fastLog(x > kTiny ? x : kTiny);
}

}  // namespace semantic_octree
