#pragma once
#include <colored_graph/ColoredAStar.h>
#include <colored_graph/CostModel.h>

#include <memory>

namespace colored_graph {

/** COLPA*: keeps the optimal path while the graph changes and the start moves.
 *
 * Lifelong planning A* (Koenig, Likhachev, Furcy 2004) over cost vectors, from the goal as in D*
 * Lite. What was found before stays. Only vertices whose cost to the goal changed and matters for
 * the path are looked at again. It follows the graph's change log, so nobody has to tell it what
 * changed. Edges are lazy: unevaluated ones count with their lower bound. Those on the best path
 * are evaluated from the start on, and the path is repaired until none is left. A path that is
 * optimal under lower bounds and is evaluated is optimal (LazySP, Dellin and Srinivasa 2016). Where
 * repairs have taken as long as all evaluations would, a vertex's edge is evaluated before it is
 * expanded. */
class ColoredReplanner {
 public:
  /** \param graph must outlive the replanner.
   * \throw std::invalid_argument model invalid. */
  ColoredReplanner(ColoredGraph& graph, VertexId start, VertexId goal, const CostModel& model,
                   const SearchOptions& options = {});
  ~ColoredReplanner();
  ColoredReplanner(ColoredReplanner&&) noexcept;
  ColoredReplanner& operator=(ColoredReplanner&&) noexcept;

  /** The optimal path in the graph as it is now, equal to findColoredPath()'s in cost and number of
   * edges. After Cancelled the next call goes on where this one stopped.
   * \throw std::invalid_argument as findColoredPath(), and where it is noticed that the lower bound
   * of lengths is not consistent. After any exception the next call starts over. */
  PathResult solve();

  /** The robot has moved; takes effect in the next solve(). */
  void moveStart(VertexId start);

 private:
  class Search;
  std::unique_ptr<Search> m_search;
};

}  // namespace colored_graph
