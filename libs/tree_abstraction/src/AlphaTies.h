#pragma once
#include <cmath>

namespace tree_abstraction {

/** Whether two taus agree but for rounding. */
inline bool isTie(double larger, double smaller) {
  constexpr double kTolerance = 1e-12;
  return larger == smaller || larger - smaller <= kTolerance * smaller;
}

/** Amid the alphas of a tree; infinite if only an infinite alpha gives it. */
inline double alphaBetween(double low, double high) {
  if (std::isfinite(high)) return low + 0.5 * (high - low);
  return low > 0 ? 2.0 * low : 1.0;
}

}  // namespace tree_abstraction
