// What bounds save.
#include <colored_graph/ColoredAStar.h>
#include <gtest/gtest.h>

#include "PlaneGraph.h"

using namespace colored_graph;

TEST(ColoredAStar, boundsSaveExpansions) {
  std::size_t none = 0, length = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 400, 20000, 40, 5);
    const CostModel model{ClassOrder(5, {{0, 1, 2, 3, 4}})};
    none += findColoredPath(plane.graph, 0, 1, model).statistics.expansions;
    length += findColoredPath(plane.graph, 0, 1, model, boundedBy(plane)).statistics.expansions;
  }
  EXPECT_LT(length, none / 2);
}

TEST(ColoredAStar, whereThereIsNoPathNothingIsExpandedTwice) {
  // A square of 96 x 96 and, apart from it, the start: every lower bound is infinite.
  ColoredGraph graph(2);
  const VertexId width = 96, start = width * width;
  for (VertexId v = 0; v <= start; ++v) graph.addVertex(0);
  for (VertexId v = 0; v < start; ++v) {
    if ((v + 1) % width) graph.addEdge(v, v + 1, {{v % 7 == 0, 10}});
    if (v + width < start) graph.addEdge(v, v + width, {{v % 5 == 0, 10}});
  }
  const CostModel model{ClassOrder(2, {{0}, {1}})};
  for (const bool oneWay : {false, true}) {
    if (oneWay) graph.addEdge(0, start, {{0, 10}}, {0, kClosed});  // leads to the start only
    const PathResult result = findColoredPath(graph, start, 0, model);
    EXPECT_EQ(result.status, SearchStatus::NotConnected);
    EXPECT_LE(result.statistics.expansions, graph.vertexCount());
  }
}
