#pragma once
#include <array>

namespace semantic_planning {

/** The digits of i in a base, mirrored at the point: a number in [0, 1). */
inline double radicalInverse(unsigned i, unsigned base) {
  double inverse = 0, weight = 1;
  for (; i > 0; i /= base) {
    weight /= base;
    inverse += weight * (i % base);
  }
  return inverse;
}

/** The i-th point, from 1 on, of a sequence that fills [0, 1)^4 evenly (Halton, "On the efficiency
 * of certain quasi-random sequences of points in evaluating multi-dimensional integrals", 1960). */
inline std::array<double, 4> haltonPoint(unsigned i) {
  return {radicalInverse(i, 2), radicalInverse(i, 3), radicalInverse(i, 5), radicalInverse(i, 7)};
}

}  // namespace semantic_planning
