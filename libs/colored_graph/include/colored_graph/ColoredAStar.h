#pragma once
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/CostModel.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace colored_graph {

/** What a search may use, and when it gives up. The functions must not change the graph. */
struct SearchOptions {
  /** Lower bound of the length of every path between two vertices; none: 0. It has to be
   * consistent: bound(s, w) <= bound(s, v) + length(v, w) for every edge that can be driven from v
   * to w. Unevaluated ones have their least length. A metric, rounded with lengthDown(), serves.
   */
  std::function<Length(VertexId, VertexId)> lengthBound;
  /** The profile of an unevaluated edge, or nothing if it is blocked. The graph keeps the answer.
   * Needed only if the search meets unevaluated edges. */
  std::function<std::optional<EdgeProfile>(EdgeId)> evaluate;
  /** Asked often; the search stops when it answers true. */
  std::function<bool()> cancelled;
};

/** How a search ended; everything but Found says why there is no path. */
enum class SearchStatus {
  Found,
  StartNotInGraph,
  GoalNotInGraph,
  NotConnected,   ///< blocked edges left out, no path leads from start to goal
  OnlyForbidden,  ///< paths exist, and all go through a forbidden class
  CostOverflow,   ///< paths exist whose cost is above 2^63 - 1 in a component
  Cancelled
};

/** A sentence for people. */
const char* describe(SearchStatus status);

struct SearchStatistics {
  std::size_t expansions = 0;      ///< vertices whose edges were looked at
  std::size_t edgesEvaluated = 0;  ///< calls of SearchOptions::evaluate
};

struct PathResult {
  SearchStatus status = SearchStatus::NotConnected;
  std::vector<VertexId> vertices;  ///< start to goal; empty if there is no path
  std::vector<EdgeId> edges;       ///< one fewer than the vertices
  /** Worst rank first: a number for each rank but rank 0, then the total length with tolls, if the
   * model counts these, then without (CostKind). */
  std::vector<std::int64_t> cost;
  /** By class id: what the profiles of the edges add up to, whatever the edge model. */
  std::vector<Length> lengthPerClass;
  SearchStatistics statistics;

  bool found() const { return status == SearchStatus::Found; }
};

/** COA*: the path from start to goal of the least cost vector.
 *
 * The function is the first search of ColoredReplanner: A* over cost vectors, from the goal. Each
 * edge is evaluated at most once and most never are. Among paths of equal cost and as many edges,
 * it takes the smaller vertex id at each step from the start. \param graph keeps the profiles of
 * the edges that were evaluated. \throw std::invalid_argument invalid model, an unevaluated edge
 * without options.evaluate, an evaluation below the edge's least length, an inconsistent lower
 * bound of lengths. */
PathResult findColoredPath(ColoredGraph& graph, VertexId start, VertexId goal,
                           const CostModel& model, const SearchOptions& options = {});

}  // namespace colored_graph
