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
    length +=
        findColoredPath(plane.graph, 0, 1, model, boundedBy(plane, false)).statistics.expansions;
  }
  EXPECT_LT(length, none / 2);
}

TEST(ColoredAStar, worstRankBoundLooksAcrossABarrier) {
  // Two halves of a strip, joined by edges of the worst class: without the bound the whole half
  // at the goal is searched before the barrier is crossed.
  ColoredGraph graph(2);
  const int width = 60, height = 20;
  const auto id = [&](int x, int y) { return static_cast<VertexId>(y * width + x); };
  for (int i = 0; i < width * height; ++i) graph.addVertex(0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const GraphClass across = x + 1 == width / 2 ? 1 : 0;
      if (x + 1 < width) graph.addEdge(id(x, y), id(x + 1, y), {{across, 10}});
      if (y + 1 < height) graph.addEdge(id(x, y), id(x, y + 1), {{0, 10}});
    }
  const CostModel model{ClassOrder(2, {{0}, {1}})};
  ColoredAStarOptions options;
  options.lengthBound = [&](VertexId a, VertexId b) -> Length {
    const int dx = static_cast<int>(a % width) - static_cast<int>(b % width);
    const int dy = static_cast<int>(a / width) - static_cast<int>(b / width);
    return 10 * (std::abs(dx) + std::abs(dy));
  };
  const VertexId start = id(width / 2 - 5, 10), goal = id(width / 2 + 5, 10);
  const PathResult without = findColoredPath(graph, start, goal, model, options);
  options.boundWorstRank = true;
  const PathResult with = findColoredPath(graph, start, goal, model, options);
  EXPECT_EQ(with.cost, without.cost);
  EXPECT_LT(with.statistics.expansions * 10, without.statistics.expansions);
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
  ColoredAStarOptions options;
  for (const bool bounded : {false, true}) {
    options.boundWorstRank = bounded;
    const PathResult result = findColoredPath(graph, start, 0, model, options);
    EXPECT_EQ(result.status, SearchStatus::NotConnected);
    EXPECT_LE(result.statistics.expansions, bounded ? 0u : graph.vertexCount());
  }
  graph.addEdge(0, start, {{0, 10}}, {0, kClosed});  // leads to the start only
  EXPECT_EQ(findColoredPath(graph, start, 0, model, options).statistics.expansions, 0u);
}
