#include <colored_graph/ColoredAStar.h>
#include <colored_graph/ColoredReplanner.h>
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>

#include "EdgeChanges.h"
#include "Oracles.h"

using namespace colored_graph;
using oracles::Tuple;

namespace {

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

/** Poses that a vehicle may reach forwards or backwards: vertex 2 i + gear of pose i. */
struct Street {
  explicit Street(int poses) {
    for (int i = 0; i < poses; ++i) {
      const VertexId forwards = graph.addVertex(0), backwards = graph.addVertex(0);
      graph.addEdge(forwards, backwards, {{0, 0}}, {kGearChange, kGearChange});
    }
  }
  /** A curve that can be driven from i to j forwards, from j to i backwards. */
  void join(int i, int j, Length length) {
    graph.addEdge(at(i, 0), at(j, 0), {{0, length}}, {0, kClosed});
    graph.addEdge(at(j, 1), at(i, 1), {{0, length}}, {2 * length, kClosed});
  }
  static VertexId at(int pose, int gear) { return static_cast<VertexId>(2 * pose + gear); }

  static constexpr Length kGearChange = 20;
  ColoredGraph graph{1};
};

}  // namespace

TEST_F(TollsIn, anEdgeThatLeadsOneWayIsDrivenOneWay) {
  graph.addEdge(0, 1, {{0, 10}}, {0, kClosed});
  EXPECT_EQ(solve(0, 1).cost, (Tuple{0, 10, 10}));
  EXPECT_EQ(solve(1, 0).status, SearchStatus::NotConnected);
  model.tolls = false;
  EXPECT_EQ(solve(0, 1).cost, (Tuple{0, 10}));
  EXPECT_EQ(solve(1, 0).status, SearchStatus::NotConnected);
}

TEST_F(TollsIn, eachWayHasItsOwnToll) {
  const EdgeId e = graph.addEdge(0, 1, {{0, 10}}, {3, 50});
  EXPECT_EQ(solve(0, 1).cost, (Tuple{0, 13, 10}));
  EXPECT_EQ(solve(1, 0).cost, (Tuple{0, 60, 10}));
  setTolls(graph, e, {0, 1});
  EXPECT_EQ(solve(1, 0).cost, (Tuple{0, 11, 10}));
}

TEST_F(TollsIn, decideAfterTheClassesAndBeforeLength) {
  const EdgeId grass = graph.addEdge(0, 1, {{0, 5}, {1, 1}});
  const EdgeId dear = graph.addEdge(0, 1, {{0, 10}}, {100, 100});
  const EdgeId detour = graph.addEdge(0, 1, {{0, 109}});
  EXPECT_EQ(solve(0, 1).edges, std::vector<EdgeId>{detour});
  model.tolls = false;
  EXPECT_EQ(solve(0, 1).edges, std::vector<EdgeId>{dear});
  graph.setBlocked(dear);
  graph.setBlocked(detour);
  EXPECT_EQ(solve(0, 1).edges, std::vector<EdgeId>{grass});
}

TEST_F(TollsIn, ofEqualSumsTheShorterWayIsTaken) {
  graph.addEdge(0, 1, {{0, 20}});
  const EdgeId shorter = graph.addEdge(0, 1, {{0, 10}}, {10, 10});
  EXPECT_EQ(solve(0, 1).edges, std::vector<EdgeId>{shorter});
}

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

TEST(Tolls, priceGearChangesAndMetersBackwardsOfPosesWithAGear) {
  Street street(4);
  street.join(0, 1, 10);  // backwards out of 1 to 0, then forwards by way of 2 to 3: a cusp
  street.join(0, 2, 10);
  street.join(2, 3, 10);
  const CostModel model{ClassOrder(1, {{0}}), EdgeModel::Profile, CostKind::ArcLength, true};
  const auto solve = [&] {
    return findColoredPath(street.graph, Street::at(1, 0), Street::at(3, 0), model).cost;
  };
  EXPECT_EQ(solve(), (Tuple{20 + 30 + 20 + 10 + 10, 30}));
  street.join(1, 3, 91);
  EXPECT_EQ(solve(), (Tuple{90, 30}));
  street.join(1, 3, 89);
  EXPECT_EQ(solve(), (Tuple{89, 89}));
}
