#pragma once
#include <colored_graph/ColoredAStar.h>

#include <functional>
#include <optional>
#include <vector>

/** \file What a search does with a graph, whatever its costs are. */

namespace colored_graph {

/** Whether a search should stop. */
class StopCheck {
 public:
  explicit StopCheck(const SearchOptions& options) : m_options(options) {}

  /** Before something that may take long. */
  std::optional<SearchStatus> now() const {
    if (m_options.cancelled && m_options.cancelled()) return SearchStatus::Cancelled;
    return std::nullopt;
  }

  /** In a loop whose turns are short: looks in the first turn and then in every 32nd. */
  std::optional<SearchStatus> inLoop() { return m_turns++ % 32 == 0 ? now() : std::nullopt; }

 private:
  const SearchOptions& m_options;
  unsigned m_turns = 0;
};

/** StartNotInGraph or GoalNotInGraph, if so. */
std::optional<SearchStatus> missingEnd(const ColoredGraph& graph, VertexId start, VertexId goal);

/** A result with status, vertices, edges and lengths per class: the path that leaves start along
 * `edges`. */
PathResult assemblePath(const ColoredGraph& graph, VertexId start, std::vector<EdgeId> edges);

/** Why there is no path, given whether the cost model lets a vertex be left along an edge. */
SearchStatus diagnose(const ColoredGraph& graph, VertexId start, VertexId goal,
                      const std::function<bool(const Incidence&)>& allowed);

/** Evaluates an edge and lets the graph keep the answer.
 * \throw std::invalid_argument no function given. */
void evaluateEdge(ColoredGraph& graph, EdgeId e,
                  const std::function<std::optional<EdgeProfile>(EdgeId)>& evaluate);

}  // namespace colored_graph
