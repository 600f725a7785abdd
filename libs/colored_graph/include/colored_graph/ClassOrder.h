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
 * are forbidden: an edge that has one cannot be used. Each rank has a rate: so many meters more of
 * driving a meter of it is worth avoiding (0 for the best rank). Searches of a graph compare the
 * lengths in classes rank by rank, as if all rates were infinite. */
class ClassOrder {
 public:
  /** \param bestToWorst for every rank the classes that share it, e.g. {{road, parking}, {grass}}.
   * \throw std::invalid_argument order empty, a rank without a class, more than 16 ranks, a class
   * that is not below `classes`, or a class named twice. */
  ClassOrder(int classes, const std::vector<std::vector<GraphClass>>& bestToWorst);
  /** \param rates of all ranks but the best, none below the one before; an infinite one, and those
   * after it, outweigh any length in better ranks. \throw std::invalid_argument one rate too few or
   * too many, or one that is negative, no number, below the one before, or finite and more than
   * kHighestRate. */
  ClassOrder withRates(const std::vector<double>& rates) const;
  /** All rates infinite: classes come before length, as in the paper. */
  ClassOrder strict() const;

  int classes() const { return static_cast<int>(m_rankOfClass.size()); }
  int ranks() const { return m_ranks; }
  /** Rank of a class, or kForbidden. */
  Rank rank(GraphClass id) const { return m_rankOfClass[id]; }
  /** Meters of driving that a meter of a rank counts beside its own. */
  double rate(Rank rank) const { return m_rates[static_cast<std::size_t>(rank)]; }

  static constexpr double kHighestRate = 1000;

 private:
  void assign(GraphClass id, Rank rank);

  int m_ranks;
  std::vector<Rank> m_rankOfClass;
  std::vector<double> m_rates;  ///< by rank
};

}  // namespace colored_graph
