#pragma once
#include <cmath>

namespace semantic_octree {

/** Nearest of the values on which float additions are exact up to 64: multiples of 2^-18. */
inline float onGrid(double logOdds) {
  constexpr double kPerUnit = 1 << 18;
  return static_cast<float>(std::round(logOdds * kPerUnit) / kPerUnit);
}

}  // namespace semantic_octree
