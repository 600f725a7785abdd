#pragma once
#include <cstdint>
#include <vector>

namespace colored_graph {

/** Number of a class of a graph, from 0 on; what it stands for is the user's. */
using GraphClass = std::uint16_t;

/** Place of a class in the order: 0 is best. */
using Rank = int;
constexpr Rank kMaxRanks = 16;
/** Rank of a class that must not be entered: worse than every other. */
constexpr Rank kForbidden = 1 << 20;

/** The order of a graph's classes 0..classes-1 from best to worst. Classes that it does not name
 * are forbidden: an edge that has one cannot be used. */
class ClassOrder {
 public:
  /** \param bestToWorst for every rank the classes that share it, e.g. {{road, parking}, {grass}}.
   * \throw std::invalid_argument order empty, a rank without a class, more than 16 ranks, a class
   * that is not below `classes`, or a class named twice. */
  ClassOrder(int classes, const std::vector<std::vector<GraphClass>>& bestToWorst);

  int classes() const { return static_cast<int>(m_rankOfClass.size()); }
  int ranks() const { return m_ranks; }
  /** Rank of a class, or kForbidden. */
  Rank rank(GraphClass id) const { return m_rankOfClass[id]; }

 private:
  void assign(GraphClass id, Rank rank);

  int m_ranks;
  std::vector<Rank> m_rankOfClass;
};

}  // namespace colored_graph
