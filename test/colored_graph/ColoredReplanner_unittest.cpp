#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredReplanner.h>
#include <gtest/gtest.h>

#include "Oracles.h"
#include "PlaneGraph.h"

using namespace colored_graph;
using oracles::costOf;

namespace {

constexpr double kReach = 5;  // cells

PlaneGraph town(unsigned seed) { return randomPlaneGraph(seed, 150, 8000, 24, kReach); }

/** Inserts a vertex with some edges, as a refined cell of the map would. */
void insertVertex(PlaneGraph& plane) {
  plane.addVertex();
  for (int i = 0; i < 400; ++i) plane.addEdge(kReach);
}

/** One random change of a vertex or an edge; start and goal stay. */
void change(PlaneGraph& plane, VertexId start, VertexId goal, bool tolled = false) {
  ColoredGraph& graph = plane.graph;
  const EdgeId e = plane.randomEdge();
  switch (plane.below(8)) {
    case 0:
      graph.setVertexClass(plane.randomVertex(), plane.randomClass());
      break;
    case 1:
      graph.setBlocked(e);
      break;
    case 2:
      graph.removeEdge(e);
      break;
    case 3:
      plane.addEdge(kReach);
      break;
    case 4: {
      const VertexId v = plane.randomVertex();
      if (v != start && v != goal && graph.vertexCount() > 120) graph.removeVertex(v);
      break;
    }
    case 5:
      if (graph.vertexCount() < 180) insertVertex(plane);
      break;
    case 6:
      if (tolled) setTolls(graph, e, plane.randomTolls());
      break;
    default:
      graph.setProfile(e, plane.randomProfile(graph.edge(e).a, graph.edge(e).b));
  }
}

struct Tally {
  std::size_t incremental = 0, scratch = 0, found = 0;
};

/** `changes` random changes, each followed by a comparison with a search from scratch. */
void compare(unsigned seed, const CostModel& model, int changes, bool moving, Tally& tally) {
  PlaneGraph plane = town(seed);
  if (model.tolls) plane.addTolls();
  VertexId start = 0;
  const VertexId goal = 1;
  const SearchOptions options = boundedBy(plane);
  ColoredReplanner replanner(plane.graph, start, goal, model, options);
  replanner.solve();
  for (int i = 0; i < changes; ++i) {
    change(plane, start, goal, model.tolls);
    const PathResult result = replanner.solve();
    const PathResult scratch = findColoredPath(plane.graph, start, goal, model, options);
    ASSERT_EQ(costOf(result), oracles::tupleDijkstra(plane.graph, model, start, goal))
        << "seed " << seed << ", change " << i;
    ASSERT_EQ(result.status, scratch.status);
    ASSERT_EQ(result.edges, scratch.edges) << "seed " << seed << ", change " << i;
    ASSERT_EQ(result.lengthPerClass, scratch.lengthPerClass);
    tally.incremental += result.statistics.expansions;
    tally.scratch += scratch.statistics.expansions;
    tally.found += result.found();
    if (!moving || i % 3) continue;
    const bool jump = !result.found() || result.vertices.size() < 3;
    start = jump ? plane.randomVertex() : result.vertices[1];
    replanner.moveStart(start);
  }
}

}  // namespace

TEST(ColoredReplanner, equalsScratchAfterEachOfFiveThousandChangesAlsoWithAMovingStart) {
  Tally tally;
  unsigned seed = 0;
  for (const bool moving : {false, true})
    for (const CostModel& model : allModels(town(seed).randomOrder())) {
      compare(seed++, model, 210, moving, tally);  // 24 times
      if (HasFatalFailure()) return;
    }
  const double ratio = double(tally.incremental) / double(tally.scratch);
  RecordProperty("expansionsRelativeToScratch", std::to_string(ratio));
  EXPECT_LT(ratio, 0.7);
  EXPECT_GT(tally.found, 3000u);
}

TEST(ColoredReplanner, staysExactWithLazyEdgesThatChange) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    PlaneGraph plane = town(seed);
    if (seed % 2) plane.addTolls();
    ColoredGraph graph = plane.graph;
    const VertexId start = 0, goal = 1;
    const CostModel model = allModels(plane.randomOrder())[seed % 12];
    SearchOptions options = boundedBy(plane);
    options.evaluate = [&](EdgeId e) -> std::optional<EdgeProfile> {
      if (plane.graph.edge(e).state == EdgeState::Blocked) return std::nullopt;
      return plane.graph.edge(e).profile;
    };
    ColoredReplanner replanner(graph, start, goal, model, options);
    for (int i = 0; i < 50; ++i) {
      for (int changes = 0; changes < 5; ++changes) {  // the map changes below an edge
        const EdgeId e = plane.randomEdge();
        const VertexId a = graph.edge(e).a, b = graph.edge(e).b;
        plane.graph.setProfile(e, plane.randomProfile(a, b));
        setUnevaluated(graph, e, plane.bound(a, b));
      }
      for (EdgeId e = 0; i == 0 && e < graph.edgeIdEnd(); ++e)
        setUnevaluated(graph, e, plane.bound(graph.edge(e).a, graph.edge(e).b));
      ASSERT_EQ(costOf(replanner.solve()), oracles::tupleDijkstra(plane.graph, model, start, goal))
          << "seed " << seed << ", round " << i;
    }
  }
}

TEST(ColoredReplanner, startsOverWhenTheLogHasForgottenChanges) {
  PlaneGraph plane = town(3);
  const CostModel model{plane.randomOrder()};
  ColoredReplanner replanner(plane.graph, 0, 1, model, boundedBy(plane));
  replanner.solve();
  for (int i = 0; i < 2000; ++i) change(plane, 0, 1);
  ASSERT_GT(plane.graph.changes().begin(), 10000u);
  EXPECT_EQ(costOf(replanner.solve()), oracles::tupleDijkstra(plane.graph, model, 0, 1));
}

TEST(ColoredReplanner, expandsNothingWhenNothingChanged) {
  PlaneGraph plane = town(4);
  const CostModel model{plane.randomOrder()};
  ColoredReplanner replanner(plane.graph, 0, 1, model, boundedBy(plane));
  const PathResult first = replanner.solve();
  const PathResult second = replanner.solve();
  EXPECT_GT(first.statistics.expansions, 0u);
  EXPECT_EQ(second.statistics.expansions, 0u);
  EXPECT_EQ(second.edges, first.edges);
}
