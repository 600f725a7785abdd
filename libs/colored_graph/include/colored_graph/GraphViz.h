#pragma once
#include <colored_graph/ColoredGraph.h>
#include <colored_graph/PathResult.h>

#include <functional>
#include <ostream>
#include <string>
#include <utility>

namespace colored_graph {

struct GraphVizOptions {
  /** GraphViz color of a class, such as "gray50" or "#a0c000"; none: all black. */
  std::function<std::string(GraphClass)> color;
  /** Where a vertex is drawn (`neato -n2` keeps it), in points; none: GraphViz decides. */
  std::function<std::pair<double, double>(VertexId)> position;
};

/** Writes the graph in the DOT language. A vertex has the color of its class, an edge that of the
 * longest class in its profile and its length in meters as label; unevaluated edges are dashed,
 * blocked ones dotted, those that lead one way have an arrow, those of the path are bold.
 * \throw std::ios_base::failure the stream did not take it all. */
void writeGraphViz(std::ostream& out, const ColoredGraph& graph, const PathResult& path = {},
                   const GraphVizOptions& options = {});

}  // namespace colored_graph
