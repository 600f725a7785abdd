#pragma once
#include <tree_abstraction/AbstractionWeights.h>
#include <tree_abstraction/Information.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

/** \file
 * Weighted Jensen-Shannon divergence of the children of a node, in nats:
 *
 *     JS = h(q) - sum_i pi_i h(p_i),    q = sum_i pi_i p_i,
 *
 * for children with shares pi_i of their parent's weight (sum 1) and distributions p_i. It is the
 * information about the variable that is lost when the children are merged (Larsson et al., G-tree
 * search). Children are rows, `stride` doubles apart. Nothing here allocates or checks its input.
 *
 * Two forms. The stable one sums terms that are all >= 0, hence is exact to a relative precision
 * however alike the children are, for 2 logarithms per child and outcome. The fast one subtracts
 * entropies that the caller keeps, hence needs only the mixture's entropy anew, and has an absolute
 * error of about 1e-16. Both are exactly 0 if all children with a share are equal. */

namespace reference {

using namespace tree_abstraction;
using tree_abstraction::entropy;  // beside the one below

/** Entropy of a yes-or-no variable that is true with probability p, in nats. */
inline double binaryEntropy(double p) { return 0.0 - xLogX(p) - xLogX(1.0 - p); }

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

/** Mixture of one outcome's probability: sum_i pi_i p[i * stride]. */
inline double mixture(const double* pi, const double* p, std::size_t n, std::size_t stride = 1) {
  return pairwiseSum(n, [=](std::size_t i) { return pi[i] * p[i * stride]; });
}

/** Mixture of rows of `width` doubles that follow one another: out[k] = sum_i pi_i rows[i * width +
 * k]. */
inline void mixRows(const double* pi, const double* rows, std::size_t n, std::size_t width,
                    double* out) {
  for (std::size_t k = 0; k < width; ++k) out[k] = mixture(pi, rows + k, n, width);
}

/** Whether all children that have a share (pi_i > 0) agree in `outcomes` doubles, bit for bit. */
inline bool allEqual(const double* pi, const double* p, std::size_t n, std::size_t outcomes,
                     std::size_t stride) {
  const double* first = nullptr;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(pi[i] > 0)) continue;
    if (!first) first = p + i * stride;
    if (!std::equal(first, first + outcomes, p + i * stride)) return false;
  }
  return true;
}

/** phi(t) = (1 + t) ln(1 + t) - t for t >= -1; >= 0, with its full relative precision at t near 0.
 */
inline double phi(double t) {
  if (t <= -1.0) return 1.0;
  if (std::abs(t) >= 0.02) return (1.0 + t) * std::log1p(t) - t;
  // sum over k >= 2 of (-t)^k / (k (k - 1)); what is left out is below 1e-17 of the sum.
  const double s = -t;
  double sum = 0;
  for (int k = 11; k >= 2; --k) sum = sum * s + 1.0 / (k * (k - 1));
  return s * s * sum;
}

/** Share of one outcome in the stable form: sum_i pi_i q phi((p_i - q) / q). */
inline double outcomeDivergence(const double* pi, const double* p, std::size_t n,
                                std::size_t stride, double q) {
  if (!(q > 0)) return 0.0;
  return q * pairwiseSum(n, [=](std::size_t i) {
           return pi[i] > 0 ? pi[i] * phi((p[i * stride] - q) / q) : 0.0;
         });
}

/** Stable JS of a variable with `outcomes` outcomes. p: n rows of that many probabilities. */
inline double jensenShannon(const double* pi, const double* p, std::size_t n, std::size_t outcomes,
                            std::size_t stride) {
  if (allEqual(pi, p, n, outcomes, stride)) return 0.0;
  double sum = 0;
  for (std::size_t y = 0; y < outcomes; ++y) {
    sum += outcomeDivergence(pi, p + y, n, stride, mixture(pi, p + y, n, stride));
  }
  return sum;
}

/** Stable JS of a yes-or-no variable. p: n probabilities of "yes", `stride` doubles apart. */
inline double binaryJensenShannon(const double* pi, const double* p, std::size_t n,
                                  std::size_t stride = 1) {
  if (allEqual(pi, p, n, 1, stride)) return 0.0;
  const double q = mixture(pi, p, n, stride), notQ = 1.0 - q;
  const double yes = outcomeDivergence(pi, p, n, stride, q);
  if (!(notQ > 0)) return yes;
  // (1 - p_i) - (1 - q) = q - p_i: differences of the complements without forming them.
  return yes + notQ * pairwiseSum(n, [=](std::size_t i) {
                 return pi[i] > 0 ? pi[i] * phi((q - p[i * stride]) / notQ) : 0.0;
               });
}

/** Fast JS from the mixture's entropy and the children's, `stride` doubles apart; clamped at 0. If
 * the children may be equal with unequal shares, ask allEqual() first: then only rounding is left.
 */
inline double entropyDrop(double mixtureEntropy, const double* pi, const double* entropies,
                          std::size_t n, std::size_t stride = 1) {
  return std::max(0.0, mixtureEntropy - mixture(pi, entropies, n, stride));
}

/** Children's distributions as an Eigen matrix, one child a row. */
using ChildRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/** Stable JS of children given as rows. \throw std::invalid_argument pi and p differ in length. */
double jensenShannon(const Eigen::Ref<const Eigen::VectorXd>& pi, const ChildRows& p);

/** Rows as TermSet lays them out, with what the search computes on them. */
class TermRows : public TermSet {
 public:
  using TermSet::TermSet;

  /** Row of a node whose classes 0..K have these K + 1 probabilities. */
  void project(const double* distribution, double* row) const;

  /** Entropy of a term's variable in a row, in nats. */
  double entropy(std::size_t term, const double* row) const {
    const auto [offset, count] = slot(term);
    return count == 1 ? binaryEntropy(row[offset]) : tree_abstraction::entropy(row + offset, count);
  }

  /** Stable JS of a term among n children with shares pi, whose rows follow one another. */
  double divergence(std::size_t term, const double* pi, const double* rows, std::size_t n) const {
    const auto [offset, count] = slot(term);
    return count == 1 ? binaryJensenShannon(pi, rows + offset, n, width())
                      : reference::jensenShannon(pi, rows + offset, n, count, width());
  }
};

}  // namespace reference
