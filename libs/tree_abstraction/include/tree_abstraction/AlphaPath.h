#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tree_abstraction {

/** All optimal trees, from the roots alone (tree 0) to the optimum at alpha = 0 (the last one).
 *
 * Each tree holds all nodes of the one before. Nodes whose taus agree but for rounding (1e-12) come
 * in together, so that every tree is the optimum of some alpha. */
class AlphaPath {
 public:
  /** \param tau From collapseAlphas(). \throw std::invalid_argument a tau that is not a number. */
  explicit AlphaPath(std::vector<double> tau);

  const std::vector<double>& tau() const { return m_tau; }
  std::size_t numTrees() const { return m_end.size(); }

  /** Tree k is optimal from lowestAlpha(k) on and below highestAlpha(k). */
  double lowestAlpha(std::size_t k) const;
  double highestAlpha(std::size_t k) const;
  /** An alpha amid those two, where the search finds tree k whatever the rounding; infinite if only
   * an infinite alpha gives the tree. */
  double alpha(std::size_t k) const;

  /** Per node of tau(): whether tree k expands it. */
  std::vector<char> expanded(std::size_t k) const;
  /** Per tree: `base` plus the sum of `amounts` over the nodes it expands. Counts leaves (number of
   * children - 1 a node), bytes, information (p(n) JS) along the path.
   * \throw std::invalid_argument as many amounts as nodes expected. */
  std::vector<double> totals(const std::vector<double>& amounts, double base) const;

  /** The largest tree whose total is at most `budget`.
   * \param costs Per node what expanding it adds, >= 0. \param base What the roots alone cost.
   * \throw std::invalid_argument naming the field: a bad cost, or a budget below `base`. */
  std::size_t largestWithin(double budget, const std::vector<double>& costs, double base) const;
  /** The same for a wanted number of leaves.
   * \param addedLeaves Per node the known children - 1. \param numRoots Leaves of the roots alone.
   * \throw std::invalid_argument also if more leaves are wanted than the whole tree has. */
  std::size_t largestWithLeaves(std::size_t wanted, const std::vector<double>& addedLeaves,
                                std::size_t numRoots) const;

 private:
  std::vector<double> m_tau;
  /** Nodes that some tree expands (tau > 0), largest tau first; tree k has the first m_end[k]. */
  std::vector<std::int32_t> m_order;
  std::vector<std::size_t> m_end;
};

/** Nodes the optimal tree of one alpha expands: tau > alpha.
 * \param eps Excess over alpha that counts as a tie: AbstractionWeights::eps(). */
std::vector<char> expandedAt(const std::vector<double>& tau, double alpha, double eps = 0);

}  // namespace tree_abstraction
