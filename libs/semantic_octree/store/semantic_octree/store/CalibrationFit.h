#pragma once
#include <cmath>

namespace semantic_octree {

/** e^x of x <= 0, to 1e-15 of itself; 0 below -700. The same bits everywhere: the standard
 * library's differ between its implementations. */
inline double exactExponential(double x) {
  constexpr double kLn2 = 0.69314718055994531;
  if (!(x >= -700)) return 0;
  const double power = std::floor(x / kLn2 + 0.5), rest = x - power * kLn2;
  double sum = 1;
  for (int i = 13; i > 0; --i) sum = 1 + sum * rest / i;
  return std::ldexp(sum, static_cast<int>(power));
}

}  // namespace semantic_octree
