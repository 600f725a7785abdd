#pragma once
#include <colored_graph/ColoredGraph.h>

/** \file
 * What becomes of an edge if another takes its place, and its id. */

/** One that nobody has looked at. */
inline void setUnevaluated(colored_graph::ColoredGraph& graph, colored_graph::EdgeId e,
                           colored_graph::Length minLength) {
  const colored_graph::Edge before = graph.edge(e);
  graph.removeEdge(e);
  graph.addUnevaluatedEdge(before.a, before.b, minLength, before.tolls);
}

/** One with other tolls. */
inline void setTolls(colored_graph::ColoredGraph& graph, colored_graph::EdgeId e,
                     colored_graph::Tolls tolls) {
  const colored_graph::Edge before = graph.edge(e);
  const colored_graph::EdgeProfile profile = before.profile;
  graph.removeEdge(e);
  if (before.state == colored_graph::EdgeState::Usable) {
    graph.addEdge(before.a, before.b, profile, tolls);
  } else {
    graph.addUnevaluatedEdge(before.a, before.b, before.length, tolls);
    if (before.state == colored_graph::EdgeState::Blocked) graph.setBlocked(e);
  }
}
