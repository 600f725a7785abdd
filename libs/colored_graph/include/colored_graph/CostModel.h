#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/ColoredGraph.h>

namespace colored_graph {

/** Which classes an edge counts for.
 * Endpoint: the class of its worse end point, whatever lies between (the published planner).
 * Sweep: the worst class along it, end points included.
 * Profile: each of its stretches for its own class; end points do not matter. */
enum class EdgeModel { Endpoint, Sweep, Profile };

/** What is minimized, worst class first. Total length stands for total length with tolls, then
 * total length, if the model counts tolls.
 * Count: (edges in the worst rank, ..., edges in rank 1; total length). With Profile, an edge
 * counts once in every rank that it touches.
 * ArcLength: (length in the worst rank, ..., length in rank 1; total length). Total length in the
 * place of the length in rank 0 gives the same order, since the other lengths are equal when it
 * decides. A lower bound of the distance can bound it. */
enum class CostKind { Count, ArcLength };

/** How a path is judged. Among paths of equal cost the one with fewer edges is taken, then the one
 * that goes on, from the start, to the smaller vertex id. */
struct CostModel {
  ClassOrder order;
  EdgeModel edges = EdgeModel::Sweep;
  CostKind kind = CostKind::ArcLength;
  /** Whether tolls count: after the classes, and before length. */
  bool tolls = false;

  /** Numbers in the cost of a path. */
  int components() const { return order.ranks() + (tolls ? 1 : 0); }
};

}  // namespace colored_graph
