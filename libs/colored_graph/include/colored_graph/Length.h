#pragma once
#include <cstdint>

namespace colored_graph {

/** A length in units of 0.1 mm. With integers, sums do not depend on their order: costs that are
 * equal compare equal, and the next class of the comparison decides. */
using Length = std::int64_t;
constexpr double kLengthUnitsPerMeter = 1e4;

/** Meters -> units, rounded up: for edges. A value within 1e-6 units of an integer is that integer,
 * because axis-aligned lengths between voxel centers carry rounding noise.
 * \throw std::invalid_argument negative, not a number, or above 2^62 units. */
Length lengthUp(double meters);

/** Meters -> units, rounded down: for lower bounds. With lengthUp() on the edges, a metric d keeps
 * lengthDown(d(a, goal)) <= lengthUp(d(a, b)) + lengthDown(d(b, goal)).
 * \throw std::invalid_argument as lengthUp(). */
Length lengthDown(double meters);

/** Units -> meters. */
inline double toMeters(Length length) { return static_cast<double>(length) / kLengthUnitsPerMeter; }

}  // namespace colored_graph
