#include <colored_graph/ColoredAStar.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "Oracles.h"
#include "PlaneGraph.h"

using namespace colored_graph;
using oracles::costOf;
using oracles::Tuple;

namespace {

/** The path leads from start to goal along its edges, and costs what it says. */
void expectSound(const ColoredGraph& graph, const CostModel& model, VertexId start, VertexId goal,
                 const PathResult& result) {
  ASSERT_TRUE(result.found());
  ASSERT_EQ(result.vertices.size(), result.edges.size() + 1);
  ASSERT_EQ(result.vertices.front(), start);
  ASSERT_EQ(result.vertices.back(), goal);
  Tuple cost = oracles::zero(model);
  std::vector<Length> lengths(graph.classes(), 0);
  for (std::size_t i = 0; i < result.edges.size(); ++i) {
    const Edge edge = graph.edge(result.edges[i]);
    ASSERT_EQ((std::set<VertexId>{edge.a, edge.b}),
              (std::set<VertexId>{result.vertices[i], result.vertices[i + 1]}));
    const auto step = oracles::edgeCost(graph, model, result.edges[i], result.vertices[i + 1]);
    ASSERT_TRUE(step);
    cost = oracles::sum(cost, *step);
    for (const Stretch& s : edge.profile) lengths[s.classId] += s.length;
  }
  EXPECT_EQ(result.cost, cost);
  EXPECT_EQ(result.lengthPerClass, lengths);
}

/** The graph on which the two costs disagree; its numbers were computed apart from this library. */
struct GrassAndRoad {
  GrassAndRoad() {
    for (int v = 0; v < 10; ++v) graph.addVertex(0);
    const int edges[][4] = {{0, 1, 0, 100}, {1, 2, 2, 10},  {2, 3, 2, 10},  {3, 9, 0, 100},
                            {0, 4, 0, 100}, {4, 5, 2, 90},  {5, 9, 0, 100}, {0, 6, 1, 300},
                            {6, 7, 1, 300}, {7, 9, 1, 300}, {0, 8, 1, 500}, {8, 9, 1, 500}};
    for (const auto& e : edges) graph.addEdge(e[0], e[1], {{static_cast<GraphClass>(e[2]), e[3]}});
  }
  Tuple solve(CostKind kind) {
    const CostModel model{ClassOrder(3, {{0}, {1}, {2}}), EdgeModel::Sweep, kind};
    return findColoredPath(graph, 0, 9, model).cost;
  }
  ColoredGraph graph{3};
};

}  // namespace

TEST(ColoredAStar, findsTheKnownOptimaOfBothCosts) {
  GrassAndRoad world;
  EXPECT_EQ(world.solve(CostKind::Count), (Tuple{0, 2, 1000}));
  EXPECT_EQ(world.solve(CostKind::ArcLength), (Tuple{0, 900, 900}));  // none of it in class 0
  for (const VertexId v : {6, 7, 8}) world.graph.removeVertex(v);
  EXPECT_EQ(world.solve(CostKind::Count), (Tuple{1, 0, 290}));
  EXPECT_EQ(world.solve(CostKind::ArcLength), (Tuple{20, 0, 220}));  // 200 of it in class 0
}

TEST(ColoredAStar, equalsTupleDijkstraOnTenThousandRandomGraphs) {
  int found = 0, zeroLength = 0, notFound = 0;
  for (unsigned seed = 0; seed < 10000; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 2 + seed % 23, seed % 67, 2 + seed % 5);
    if (seed % 2) plane.addTolls();
    const VertexId start = plane.randomVertex(), goal = plane.randomVertex();
    for (const CostModel& model : allModels(plane.randomOrder())) {
      const auto expected = oracles::tupleDijkstra(plane.graph, model, start, goal);
      const PathResult result = findColoredPath(plane.graph, start, goal, model, boundedBy(plane));
      ASSERT_EQ(costOf(result), expected) << "seed " << seed;
      if (expected) expectSound(plane.graph, model, start, goal, result);
      ASSERT_EQ(costOf(findColoredPath(plane.graph, start, goal, model)), expected) << seed;
      found += expected && start != goal;
      notFound += !expected;
      zeroLength += expected && start != goal && expected->back() == 0;
    }
    if (HasFatalFailure()) FAIL() << "seed " << seed;
  }
  EXPECT_GT(found, 20000);
  EXPECT_GT(notFound, 5000);
  EXPECT_GT(zeroLength, 500);
}

TEST(ColoredAStar, worksWithEveryNumberOfRanks) {
  for (int ranks = 1; ranks <= kMaxRanks; ++ranks) {
    ColoredGraph graph(kMaxRanks);
    std::vector<std::vector<GraphClass>> order;
    for (int r = 0; r < ranks; ++r) order.push_back({static_cast<GraphClass>(r)});
    for (int v = 0; v <= ranks; ++v) graph.addVertex(0);
    for (int r = 0; r < ranks; ++r) graph.addEdge(r, r + 1, {{static_cast<GraphClass>(r), 10 + r}});
    const CostModel model{ClassOrder(kMaxRanks, order), EdgeModel::Sweep, CostKind::ArcLength};
    const PathResult result = findColoredPath(graph, 0, static_cast<VertexId>(ranks), model);
    ASSERT_TRUE(result.found());
    ASSERT_EQ(result.cost.size(), static_cast<std::size_t>(ranks));
    for (int r = 1; r < ranks; ++r) EXPECT_EQ(result.cost[ranks - 1 - r], 10 + r);
    EXPECT_EQ(result.cost.back(), ranks * 10 + ranks * (ranks - 1) / 2);
  }
}

TEST(ColoredAStar, tiesGoToFewerEdgesThenToSmallerIds) {
  ColoredGraph graph(1);
  for (int v = 0; v < 7; ++v) graph.addVertex(0);
  const CostModel model{ClassOrder(1, {{0}})};
  graph.addEdge(0, 1, {{0, 10}});
  graph.addEdge(1, 2, {{0, 10}});
  graph.addEdge(2, 6, {{0, 10}});
  graph.addEdge(0, 5, {{0, 15}});
  graph.addEdge(5, 6, {{0, 15}});
  EXPECT_EQ(findColoredPath(graph, 0, 6, model).vertices, (std::vector<VertexId>{0, 5, 6}));
  graph.addEdge(4, 6, {{0, 29}});  // reached later than 5
  graph.addEdge(0, 4, {{0, 1}});
  EXPECT_EQ(findColoredPath(graph, 0, 6, model).vertices, (std::vector<VertexId>{0, 4, 6}));
  graph.addEdge(0, 4, {{0, 1}});  // a parallel edge of a larger id
  EXPECT_EQ(findColoredPath(graph, 0, 6, model).edges, (std::vector<EdgeId>{6, 5}));
}

TEST(ColoredAStar, pathDoesNotDependOnTheOrderOfInsertion) {
  EXPECT_TRUE(rc::check([] {
    const int vertices = *rc::gen::inRange(2, 15);
    struct Line {
      VertexId a, b;
      Length length;
    };
    std::vector<Line> lines;
    for (VertexId a = 0; a < static_cast<VertexId>(vertices); ++a)
      for (VertexId b = a + 1; b < static_cast<VertexId>(vertices); ++b)
        if (*rc::gen::inRange(0, 2)) lines.push_back({a, b, *rc::gen::inRange<Length>(0, 4)});
    const auto solve = [&] {
      ColoredGraph graph(1);
      for (int v = 0; v < vertices; ++v) graph.addVertex(0);
      for (const Line& l : lines) graph.addEdge(l.a, l.b, {{0, l.length}});
      return findColoredPath(graph, 0, 1, {ClassOrder(1, {{0}})}).vertices;
    };
    const auto first = solve();
    std::shuffle(lines.begin(), lines.end(), std::mt19937(*rc::gen::arbitrary<unsigned>()));
    RC_ASSERT(solve() == first);
  }));
}

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
