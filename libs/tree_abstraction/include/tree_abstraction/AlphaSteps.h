#pragma once
#include <cstddef>
#include <vector>

namespace tree_abstraction {

/** The trees of an AlphaPath in which some of its nodes come in, the largest tau first: for trees
 * of which only a part is asked for, and whose nodes would be too many for memory. */
class AlphaSteps {
 public:
  /** \param tau of all nodes, see collapseAlphas(), in any order; those that are not above 0 may be
   * left out \param asked of the nodes that are asked for, each one of `tau` or not above 0 */
  AlphaSteps(std::vector<double> tau, const std::vector<double>& asked);

  /** 0: the tree of the roots alone; the last: what no tree expands. */
  std::size_t numSteps() const { return m_lowest.size() + 2; }
  /** Of a node that was asked for: the first step that expands it. */
  std::size_t stepOf(double tau) const;
  /** As AlphaPath::alpha() and highestAlpha(). \param step not the last */
  double alpha(std::size_t step) const;
  double highestAlpha(std::size_t step) const;

 private:
  double m_highest = 0;          ///< tau; 0: there is none
  std::vector<double> m_lowest;  ///< tau of each step but the first and the last, falling
  std::vector<double> m_next;    ///< the largest tau below; 0: there is none
};

}  // namespace tree_abstraction
