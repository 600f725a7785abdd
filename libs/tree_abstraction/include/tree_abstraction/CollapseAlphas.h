#pragma once
#include <cstdint>
#include <vector>

namespace tree_abstraction {

/** The alpha from which on each inner node is no longer expanded: all optimal trees in one pass.
 *
 * Expanding node i gains gains[i] and costs alpha * prices[i]; the optimal tree is the smallest set
 * of nodes, each with its parent, of the largest sum of gain - alpha * price. It is {i : tau[i] >
 * alpha} for every alpha >= 0, so optimal trees are nested. (Weakest-link pruning as in CART and
 * BFOS, from the bottom: each node keeps the bundles of its descendants that collapse together.)
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

}  // namespace tree_abstraction
