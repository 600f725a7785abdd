#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tree_abstraction {

/** The alpha from which on each inner node is no longer expanded: all compressed trees in one pass.
 *
 * Expanding node i gains gains[i] and costs alpha * prices[i]; the compressed tree is the smallest
 * set of nodes, each with its parent, of the largest sum of gain - alpha * price. It is {i : tau[i]
 * > alpha} for every alpha >= 0, so compressed trees are nested. (Weakest-link pruning as in CART
 * and BFOS, from the bottom: each node keeps the bundles of its descendants that collapse
 * together.)
 *
 * \param parents Index of each node's parent, below the node's own index; -1 for a root. Leaves may
 * be left out, or be in with gain and price 0. \param gains r_i = p(n) sum_t weight_t JS_t(n),
 * finite. \param prices b_i >= 0, finite: p(n) H(Pi_n) for I_X, or the leaves or bytes that
 * expanding adds. \return tau: infinite for what pays at any alpha, <= 0 for what never does.
 * \throw std::invalid_argument naming the node: sizes differ, or a parent, gain or price not as
 * above. Takes O(N log N) time. */
std::vector<double> collapseAlphas(const std::vector<std::int32_t>& parents,
                                   const std::vector<double>& gains,
                                   const std::vector<double>& prices);

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

/** The compressed trees of all alphas, from the roots alone (tree 0) to that of alpha = 0 (the
 * last). Where all would be too many for memory, some of the trees.
 *
 * Each tree holds all nodes of the one before. Nodes whose taus agree but for rounding (1e-12) come
 * in together, so that every tree is that of some alpha. */
class AlphaPath {
 public:
  /** \param tau From collapseAlphas(), in any order; those that are not above 0 may be left out. */
  explicit AlphaPath(const std::vector<double>& tau) : AlphaPath(tau, tau) {}
  /** \param asked of the nodes that are asked for, each one of `tau` or not above 0 */
  AlphaPath(std::vector<double> tau, const std::vector<double>& asked);

  std::size_t numTrees() const { return m_lowest.size() + 1; }
  /** The first tree that expands a node that was asked for; numTrees() if none does. */
  std::size_t treeOf(double tau) const;
  /** Tree k is the compressed tree from lowestAlpha(k) on and below highestAlpha(k). */
  double lowestAlpha(std::size_t k) const { return k == 0 ? m_highest : m_next.at(k - 1); }
  double highestAlpha(std::size_t k) const;
  /** An alpha amid those two, where the search finds tree k whatever the rounding; infinite if only
   * an infinite alpha gives the tree. */
  double alpha(std::size_t k) const { return alphaBetween(lowestAlpha(k), highestAlpha(k)); }

 private:
  double m_highest = 0;          ///< tau; 0: there is none
  std::vector<double> m_lowest;  ///< tau of what comes in with each tree but the first, falling
  std::vector<double> m_next;    ///< the largest tau below; 0: there is none
};

}  // namespace tree_abstraction
