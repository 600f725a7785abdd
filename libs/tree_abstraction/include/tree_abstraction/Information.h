#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

/** \file
 * Shannon entropies in nats, inline and without allocation. */

namespace tree_abstraction {

constexpr double kLn2 = 0.693147180559945309417232121458;

/** Information in nats -> bits, for reports. */
constexpr double natsToBits(double nats) { return nats / kLn2; }

/** x ln x, continued by 0 at x = 0. */
inline double xLogX(double x) { return x > 0 ? x * std::log(x) : 0.0; }

/** Entropy of a distribution over `size` outcomes, in nats. */
inline double entropy(const double* p, std::size_t size) {
  double h = 0;
  for (std::size_t i = 0; i < size; ++i) h -= xLogX(p[i]);
  return h;
}

/** Entropy relative to that of the uniform distribution over as many outcomes (2 at least), 0 to 1.
 */
inline double relativeEntropy(const std::vector<double>& p) {
  return entropy(p.data(), p.size()) / std::log(static_cast<double>(p.size()));
}

}  // namespace tree_abstraction
