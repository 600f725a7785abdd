#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredReplanner.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

#include "Oracles.h"
#include "PlaneGraph.h"

using namespace colored_graph;
using oracles::costOf;

namespace {

/** A graph whose edges nobody has looked at yet, and what they turn out to be. */
struct LazyWorld {
  explicit LazyWorld(PlaneGraph& plane) : graph(plane.graph), truth(plane.graph) {
    for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
      if (graph.containsEdge(e)) setUnevaluated(graph, e, minLength(plane, e));
    }
    options.lengthBound = [&plane](VertexId a, VertexId b) { return plane.bound(a, b); };
    options.evaluate = [this](EdgeId e) -> std::optional<EdgeProfile> {
      ++calls[e];
      if (truth.edge(e).state == EdgeState::Blocked) return std::nullopt;
      return truth.edge(e).profile;
    };
  }
  Length minLength(const PlaneGraph& plane, EdgeId e) const {
    // Half of the edges promise no more than the straight line rounded down.
    const Length line = plane.bound(truth.edge(e).a, truth.edge(e).b);
    return e % 2 || truth.edge(e).state == EdgeState::Blocked ? line : truth.edge(e).length;
  }
  int evaluated() const {
    int sum = 0;
    for (const auto& [e, times] : calls) sum += times;
    return sum;
  }
  bool anyTwice() const {
    for (const auto& [e, times] : calls)
      if (times > 1) return true;
    return false;
  }

  ColoredGraph graph;
  ColoredGraph truth;
  std::map<EdgeId, int> calls;
  SearchOptions options;
};

bool allEvaluated(const ColoredGraph& graph, const PathResult& result) {
  for (const EdgeId e : result.edges)
    if (graph.edge(e).state != EdgeState::Usable) return false;
  return true;
}

}  // namespace

TEST(LazyEdges, searchFindsTheOptimumOfTheTruth) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 2 + seed % 23, seed % 67, 2 + seed % 5);
    if (seed % 2) plane.addTolls();
    const VertexId start = plane.randomVertex(), goal = plane.randomVertex();
    for (const CostModel& model : allModels(plane.randomOrder())) {
      LazyWorld world(plane);
      const PathResult result = findColoredPath(world.graph, start, goal, model, world.options);
      ASSERT_EQ(costOf(result), oracles::tupleDijkstra(plane.graph, model, start, goal))
          << "seed " << seed;
      ASSERT_TRUE(allEvaluated(world.graph, result)) << "seed " << seed;
      ASSERT_FALSE(world.anyTwice()) << "seed " << seed;
      ASSERT_EQ(result.statistics.edgesEvaluated, static_cast<std::size_t>(world.evaluated()));
    }
  }
}

TEST(LazyEdges, fewAreEvaluated) {
  std::size_t edges = 0, evaluated = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 200, 6000, 30, 6);
    const CostModel model{ClassOrder(5, {{0}, {1}, {2}, {3}, {4}})};
    LazyWorld world(plane);
    edges += plane.graph.edgeCount();
    evaluated += findColoredPath(world.graph, 0, 1, model, world.options).statistics.edgesEvaluated;
  }
  EXPECT_LT(evaluated, edges / 3);  // a search that evaluates what it expands needs more
}

TEST(LazyEdges, repairsTakeNoLongerThanEvaluationsWould) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 800, 30000, 30, 4);
    const CostModel model{ClassOrder(5, {{0}, {1}, {2}, {3}, {4}}), EdgeModel::Profile};
    LazyWorld world(plane);
    ColoredReplanner replanner(world.graph, 0, 1, model, world.options);
    PathResult result = replanner.solve();
    EXPECT_LT(result.statistics.expansions, 9 * plane.graph.edgeCount()) << seed;
    for (VertexId start = 0;; start += 2) {  // it goes on from what it found
      EXPECT_EQ(costOf(result), oracles::tupleDijkstra(plane.graph, model, start, 1)) << seed;
      if (start == 8 || result.edges.empty()) break;
      for (ColoredGraph* graph : {&world.graph, &plane.graph})
        graph->removeEdge(result.edges.back());
      replanner.moveStart(start + 2);
      result = replanner.solve();
    }
  }
}

TEST(LazyEdges, anEdgeThatHasBecomeUselessIsNotEvaluated) {
  ColoredGraph graph(1);
  for (int v = 0; v < 4; ++v) graph.addVertex(0);
  graph.addUnevaluatedEdge(3, 2, 1);
  graph.addUnevaluatedEdge(2, 1, 1);
  const EdgeId detour =
      graph.addUnevaluatedEdge(3, 1, 10);  // queued before 1 is reached by way of 2
  graph.addUnevaluatedEdge(1, 0, 100);
  SearchOptions options;
  options.evaluate = [&](EdgeId e) { return EdgeProfile{{0, graph.edge(e).length}}; };
  const CostModel model{ClassOrder(1, {{0}})};
  EXPECT_EQ(findColoredPath(graph, 0, 3, model, options).statistics.edgesEvaluated, 3u);
  EXPECT_EQ(graph.edge(detour).state, EdgeState::Unevaluated);
}

TEST(LazyEdges, answersAreKeptForTheNextSearch) {
  PlaneGraph plane = randomPlaneGraph(7, 50, 600, 10);
  LazyWorld world(plane);
  const CostModel model{ClassOrder(5, {{0}, {1}, {2}, {3}, {4}})};
  const PathResult first = findColoredPath(world.graph, 0, 1, model, world.options);
  const PathResult second = findColoredPath(world.graph, 0, 1, model, world.options);
  EXPECT_GT(first.statistics.edgesEvaluated, 0u);
  EXPECT_EQ(second.statistics.edgesEvaluated, 0u);
  EXPECT_EQ(second.cost, first.cost);
}

TEST(LazyEdges, areRefusedWithoutAFunctionOrIfThatContradictsTheBound) {
  ColoredGraph graph(1);
  graph.addVertex(0);
  graph.addVertex(0);
  graph.addUnevaluatedEdge(0, 1, 5);
  const CostModel model{ClassOrder(1, {{0}})};
  SearchOptions options;
  for (int i = 0; i < 2; ++i) {
    EXPECT_THROW(findColoredPath(graph, 0, 1, model, options), std::invalid_argument);
    EXPECT_THROW(ColoredReplanner(graph, 0, 1, model, options).solve(), std::invalid_argument);
    EXPECT_EQ(graph.edge(0).state, EdgeState::Unevaluated);
    options.evaluate = [](EdgeId) { return EdgeProfile{{0, 4}}; };
  }
}
