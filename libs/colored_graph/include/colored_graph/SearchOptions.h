#pragma once
#include <colored_graph/ColoredGraph.h>

#include <functional>
#include <limits>
#include <optional>

namespace colored_graph {

/** What a search may use, and when it gives up. The functions must not change the graph. */
struct SearchOptions {
  /** Lower bound of the length of every path between two vertices; none: 0. It has to be
   * consistent: bound(s, w) <= bound(s, v) + length(v, w) for every edge that can be driven from v
   * to w, with the least length where it is unevaluated (a metric, rounded with lengthDown(), is).
   */
  std::function<Length(VertexId, VertexId)> lengthBound;
  /** The profile of an unevaluated edge, or nothing if it is blocked. The graph keeps the answer.
   * Needed only if the search meets unevaluated edges. */
  std::function<std::optional<EdgeProfile>(EdgeId)> evaluate;
  /** Asked often; the search stops when it answers true. */
  std::function<bool()> cancelled;
  double timeLimit = std::numeric_limits<double>::infinity();  ///< s

  /** \throw std::invalid_argument time limit negative or not a number. */
  void validate() const;
};

}  // namespace colored_graph
