#pragma once
#include <colored_graph/CostModel.h>
#include <colored_graph/PathResult.h>
#include <colored_graph/SearchOptions.h>

namespace colored_graph {

struct ColoredAStarOptions : SearchOptions {
  /** Bound the cost in the worst rank exactly before the search, by one scalar pass over the
   * graph. It pays where a barrier of the worst class lies between start and goal. */
  bool boundWorstRank = false;
};

/** COA*: the path from start to goal of the least cost vector.
 *
 * A* over cost vectors with lazy edges: an unevaluated edge waits in the queue under its lower
 * bound and is evaluated only when it comes to the front, so each edge is evaluated at most once
 * and most never are. The search runs from the goal. Among paths of equal cost and as many edges,
 * it takes the smaller vertex id at each step from the start; among unevaluated edges that could
 * only tie it does not look. \param graph keeps the profiles of the edges that were evaluated.
 * \throw std::invalid_argument options or model invalid, an unevaluated edge without
 * options.evaluate, an evaluation that contradicts the edge's least length, or a lower bound of
 * lengths that turns out not to be consistent. */
PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const ColoredAStarOptions& options = {});

}  // namespace colored_graph
