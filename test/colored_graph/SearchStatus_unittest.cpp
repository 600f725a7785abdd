#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredReplanner.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "EdgeChanges.h"
#include "Oracles.h"
#include "PlaneGraph.h"

using namespace colored_graph;
using oracles::Tuple;

namespace {

class SearchStatusOf : public ::testing::Test {
 protected:
  PathResult solve(VertexId start, VertexId goal) {
    return findColoredPath(graph, start, goal, model, options);
  }

  /** A chain of n vertices. */
  void chain(int n) {
    for (int v = 0; v < n; ++v) graph.addVertex(0);
    for (VertexId v = 1; v < static_cast<VertexId>(n); ++v) graph.addEdge(v - 1, v, {{0, 10}});
  }

  ColoredGraph graph{3};
  CostModel model{ClassOrder(3, {{0}, {1}}), EdgeModel::Sweep, CostKind::ArcLength};
  SearchOptions options;
};

TEST_F(SearchStatusOf, missingEndsAreNamed) {
  chain(3);
  EXPECT_EQ(solve(7, 0).status, SearchStatus::StartNotInGraph);
  EXPECT_EQ(solve(0, 7).status, SearchStatus::GoalNotInGraph);
  graph.removeVertex(2);
  EXPECT_EQ(solve(2, 0).status, SearchStatus::StartNotInGraph);
  EXPECT_EQ(solve(0, kNoVertex).status, SearchStatus::GoalNotInGraph);
}

TEST_F(SearchStatusOf, startAtTheGoalIsAPathWithoutEdges) {
  chain(2);
  const PathResult result = solve(1, 1);
  EXPECT_EQ(result.status, SearchStatus::Found);
  EXPECT_EQ(result.vertices, std::vector<VertexId>{1});
  EXPECT_TRUE(result.edges.empty());
  EXPECT_EQ(result.cost, (Tuple{0, 0}));
  EXPECT_EQ(result.lengthPerClass, (std::vector<Length>{0, 0, 0}));
}

TEST_F(SearchStatusOf, separatePartsAreNotConnected) {
  chain(3);
  const VertexId lonely = graph.addVertex(0);
  EXPECT_EQ(solve(0, lonely).status, SearchStatus::NotConnected);
  graph.setBlocked(1);
  const PathResult result = solve(0, 2);
  EXPECT_EQ(result.status, SearchStatus::NotConnected);
  EXPECT_TRUE(result.vertices.empty());
  EXPECT_TRUE(result.cost.empty());
}

TEST_F(SearchStatusOf, aForbiddenClassInTheWayIsNamed) {
  chain(3);
  graph.setProfile(1, {{2, 10}});
  EXPECT_EQ(solve(0, 2).status, SearchStatus::OnlyForbidden);
  graph.setProfile(1, {{1, 10}});
  graph.setVertexClass(1, 2);
  EXPECT_EQ(solve(0, 2).status, SearchStatus::OnlyForbidden);
  model.edges = EdgeModel::Profile;
  EXPECT_EQ(solve(0, 2).status, SearchStatus::Found);
}

TEST_F(SearchStatusOf, aForbiddenClassInTheWayOfAnUnevaluatedEdgeIsNamed) {
  chain(2);
  setUnevaluated(graph, 0, 5);
  options.evaluate = [](EdgeId) { return EdgeProfile{{2, 10}}; };
  EXPECT_EQ(solve(0, 1).status, SearchStatus::OnlyForbidden);
  setUnevaluated(graph, 0, 5);
  options.evaluate = [](EdgeId) { return std::nullopt; };
  EXPECT_EQ(solve(0, 1).status, SearchStatus::NotConnected);
}

TEST_F(SearchStatusOf, overflowIsNoPathAndSaysSo) {
  chain(4);
  const Length huge = Length{1} << 62;
  graph.setProfile(0, {{1, huge}});
  graph.setProfile(1, {{1, huge - 1}});
  EXPECT_EQ(solve(0, 2).cost, (Tuple{huge + (huge - 1), huge + (huge - 1)}));
  graph.setProfile(2, {{1, 1}});
  EXPECT_EQ(solve(0, 3).status, SearchStatus::CostOverflow);
}

TEST_F(SearchStatusOf, cancelStopsTheSearch) {
  chain(1000);
  int asked = 0;
  options.cancelled = [&] { return ++asked > 3; };
  const PathResult result = solve(0, 999);
  EXPECT_EQ(result.status, SearchStatus::Cancelled);
  EXPECT_TRUE(result.vertices.empty());
  EXPECT_GT(result.statistics.expansions, 0u);
  EXPECT_LT(result.statistics.expansions, 500u);
}

TEST_F(SearchStatusOf, anOrderOfOtherClassesIsRefused) {
  chain(2);
  model.order = ClassOrder(2, {{0}, {1}});
  EXPECT_THROW(solve(0, 1), std::invalid_argument);
}

TEST(SearchStatus, replannerGoesOnAfterACancel) {
  PlaneGraph plane = randomPlaneGraph(11, 300, 9000, 30, 4);
  const CostModel model{ClassOrder(PlaneGraph::kClasses, {{0, 1}, {2}, {3, 4}})};
  bool stop = true;
  SearchOptions options;
  int asked = 0;
  options.cancelled = [&] { return stop && ++asked > 2; };
  ColoredReplanner replanner(plane.graph, 0, 1, model, options);
  const PathResult cancelled = replanner.solve();
  ASSERT_EQ(cancelled.status, SearchStatus::Cancelled);
  plane.graph.setBlocked(plane.graph.incident(0).front().edge);
  stop = false;
  const PathResult result = replanner.solve();
  const auto expected = oracles::tupleDijkstra(plane.graph, model, 0, 1);
  ASSERT_TRUE(expected);
  EXPECT_EQ(result.cost, *expected);
  const PathResult whole = ColoredReplanner(plane.graph, 0, 1, model).solve();
  EXPECT_LT(result.statistics.expansions, whole.statistics.expansions);
}

TEST(SearchStatus, replannerRecoversFromAFunctionThatThrows) {
  PlaneGraph plane = randomPlaneGraph(11, 300, 9000, 30, 4);
  const CostModel model{ClassOrder(PlaneGraph::kClasses, {{0, 1}, {2}, {3, 4}})};
  const auto expected = oracles::tupleDijkstra(plane.graph, model, 0, 1);
  ASSERT_TRUE(expected);
  for (int last = 1; last < 150; ++last) {  // wherever it happens
    int calls = 0;
    SearchOptions options;
    options.lengthBound = [&](VertexId a, VertexId b) {
      if (++calls == last) throw std::runtime_error("no bound today");
      return plane.bound(a, b);
    };
    ColoredReplanner replanner(plane.graph, 0, 1, model, options);
    EXPECT_THROW(replanner.solve(), std::runtime_error);
    EXPECT_EQ(replanner.solve().cost, *expected) << "thrown by call " << last;
  }
}

TEST(SearchStatus, aBoundThatIsNoneEndsInAPathOrAnErrorNotInALoop) {
  int refused = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 40, 300, 8);
    const CostModel model{ClassOrder(PlaneGraph::kClasses, {{0, 1, 2, 3, 4}})};
    SearchOptions options;
    options.lengthBound = [&](VertexId a, VertexId b) { return 5 * plane.bound(a, b); };
    ColoredReplanner replanner(plane.graph, 0, 1, model, options);
    for (int changes = 0; changes < 10; ++changes) {
      plane.graph.setBlocked(plane.randomEdge());
      try {
        const PathResult result = replanner.solve();
        EXPECT_LE(result.vertices.size(), 40u);
      } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "SearchOptions: lengthBound is not consistent");
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(SearchStatus, vertexThatABoundMadeTooLateIsExpandedAgain) {
  int found = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    PlaneGraph plane = randomPlaneGraph(seed, 40, 60, 8);
    const CostModel model{ClassOrder(PlaneGraph::kClasses, {{0, 1, 2, 3, 4}})};
    SearchOptions options;
    options.lengthBound = [&](VertexId a, VertexId b) { return b % 11 * plane.bound(a, b); };
    const PathResult result = findColoredPath(plane.graph, 0, 1, model, options);
    if (!result.found()) continue;
    ++found;
    Length length = 0;
    for (const EdgeId e : result.edges) length += plane.graph.edge(e).length;
    EXPECT_EQ(result.cost.back(), length);
  }
  EXPECT_GT(found, 50);
}

TEST(SearchStatus, replannerNoticesThatAnEndWentAndCameBack) {
  ColoredGraph graph(1);
  for (int v = 0; v < 3; ++v) graph.addVertex(0);
  graph.addEdge(0, 1, {{0, 10}});
  graph.addEdge(1, 2, {{0, 10}});
  ColoredReplanner replanner(graph, 0, 2, {ClassOrder(1, {{0}})});
  EXPECT_EQ(replanner.solve().cost, Tuple{20});
  graph.removeVertex(2);
  EXPECT_EQ(replanner.solve().status, SearchStatus::GoalNotInGraph);
  ASSERT_EQ(graph.addVertex(0), 2u);
  EXPECT_EQ(replanner.solve().status, SearchStatus::NotConnected);
  graph.addEdge(0, 2, {{0, 7}});
  EXPECT_EQ(replanner.solve().cost, Tuple{7});
  replanner.moveStart(1);
  EXPECT_EQ(replanner.solve().cost, Tuple{17});
}

class TollsIn : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int v = 0; v < 4; ++v) graph.addVertex(0);
  }
  PathResult solve(VertexId start, VertexId goal) {
    return findColoredPath(graph, start, goal, model, options);
  }

  ColoredGraph graph{2};
  CostModel model{ClassOrder(2, {{0}, {1}}), EdgeModel::Profile, CostKind::ArcLength, true};
  SearchOptions options;
};

}  // namespace

TEST_F(TollsIn, evaluationLeavesThemAsTheyAre) {
  const EdgeId e = graph.addUnevaluatedEdge(0, 1, 5, {7, kClosed});
  options.evaluate = [](EdgeId) { return EdgeProfile{{0, 6}, {1, 2}}; };
  EXPECT_EQ(solve(0, 1).cost, (Tuple{2, 15, 8}));
  EXPECT_EQ(graph.edge(e).tolls.toB, 7);
  EXPECT_EQ(solve(1, 0).status, SearchStatus::NotConnected);
}

TEST_F(TollsIn, theLargestAreNoOverflow) {
  const Length large = (Length{1} << 62) - 1;
  graph.addEdge(0, 1, {{0, large + 1}}, {large, large});
  graph.addEdge(1, 2, {{0, 1}});
  EXPECT_EQ(solve(0, 1).cost, (Tuple{0, large + large + 1, large + 1}));
  EXPECT_EQ(solve(0, 2).status, SearchStatus::CostOverflow);
}

TEST_F(TollsIn, aForbiddenClassBehindAClosedWayIsNotNamed) {
  model.order = ClassOrder(2, {{0}});
  graph.addEdge(0, 1, {{1, 10}}, {0, kClosed});
  EXPECT_EQ(solve(0, 1).status, SearchStatus::OnlyForbidden);
  EXPECT_EQ(solve(1, 0).status, SearchStatus::NotConnected);
}
