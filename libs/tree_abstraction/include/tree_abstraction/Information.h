#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>

/** \file
 * Shannon entropies in nats, inline and without allocation. */

namespace tree_abstraction {

constexpr double kLn2 = 0.693147180559945309417232121458;

/** Information in nats -> bits, for reports. */
constexpr double natsToBits(double nats) { return nats / kLn2; }
/** Information in bits -> nats. */
constexpr double bitsToNats(double bits) { return bits * kLn2; }

/** x ln x, continued by 0 at x = 0. */
inline double xLogX(double x) { return x > 0 ? x * std::log(x) : 0.0; }

/** Entropy of a yes-or-no variable that is true with probability p, in nats. */
inline double binaryEntropy(double p) { return 0.0 - xLogX(p) - xLogX(1.0 - p); }

/** Entropy of a distribution over `size` outcomes, in nats. */
inline double entropy(const double* p, std::size_t size) {
  double h = 0;
  for (std::size_t i = 0; i < size; ++i) h -= xLogX(p[i]);
  return h;
}

/** Entropy of a distribution, in nats. */
inline double entropy(const Eigen::Ref<const Eigen::VectorXd>& p) {
  return entropy(p.data(), static_cast<std::size_t>(p.size()));
}

/** term(first) + ... + term(first + n - 1), by halves all the way down. */
template <class Term>
double sumByHalves(std::size_t first, std::size_t n, const Term& term) {
  if (n == 0) return 0.0;
  if (n == 1) return term(first);
  return sumByHalves(first, n / 2, term) + sumByHalves(first + n / 2, n - n / 2, term);
}

/** Sum of term(0) ... term(n - 1) by halves: ((a+b)+(c+d))+((e+f)+(g+h)) for eight. Eight equal
 * terms thus give exactly eight times the term, as the parent of eight equal octree nodes needs. */
template <class Term>
double pairwiseSum(std::size_t n, const Term& term) {
  if (n != 8) return sumByHalves(0, n, term);
  // Written out, the octree's case is inlined.
  return ((term(0) + term(1)) + (term(2) + term(3))) + ((term(4) + term(5)) + (term(6) + term(7)));
}

}  // namespace tree_abstraction
