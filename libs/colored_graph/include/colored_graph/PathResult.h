#pragma once
#include <colored_graph/ColoredGraph.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace colored_graph {

/** How a search ended; everything but Found says why there is no path. */
enum class SearchStatus {
  Found,
  StartNotInGraph,
  GoalNotInGraph,
  NotConnected,   ///< blocked edges left out, no path leads from start to goal
  OnlyForbidden,  ///< paths exist, and all go through a forbidden class
  CostOverflow,   ///< paths exist whose cost is above 2^63 - 1 in a component
  Cancelled,
  TimeLimit
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
  /** Worst rank first: one number for each rank but rank 0, then the total length (CostKind), and
   * before it the total length with tolls, if the model counts these. */
  std::vector<std::int64_t> cost;
  /** By class id: what the profiles of the edges add up to, whatever the edge model. */
  std::vector<Length> lengthPerClass;
  SearchStatistics statistics;

  bool found() const { return status == SearchStatus::Found; }
};

}  // namespace colored_graph
