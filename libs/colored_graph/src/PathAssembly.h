#pragma once
#include <colored_graph/PathResult.h>

#include <functional>
#include <optional>
#include <vector>

namespace colored_graph {

/** StartNotInGraph or GoalNotInGraph, if so. */
std::optional<SearchStatus> missingEnd(const ColoredGraph& graph, VertexId start, VertexId goal);

/** A result with status, vertices, edges and lengths per class: the path that leaves start along
 * `edges`. */
PathResult assemblePath(const ColoredGraph& graph, VertexId start, std::vector<EdgeId> edges);

/** Why there is no path, given which edges the cost model lets through. */
SearchStatus diagnose(const ColoredGraph& graph, VertexId start, VertexId goal,
                      const std::function<bool(EdgeId)>& allowed);

/** Evaluates an edge and lets the graph keep the answer.
 * \throw std::invalid_argument no function given. */
void evaluateEdge(ColoredGraph& graph, EdgeId e,
                  const std::function<std::optional<EdgeProfile>(EdgeId)>& evaluate);

}  // namespace colored_graph
