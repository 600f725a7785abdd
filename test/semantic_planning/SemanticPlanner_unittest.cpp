#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <set>

#include "PlannerFixture.h"

using namespace semantic_planning;

namespace {

/** The path of the fewest edges, whatever their classes: breadth first. */
class FewestEdges : public colored_graph::GraphSearch {
 public:
  explicit FewestEdges(int& searches) : m_searches(searches) {}

  colored_graph::PathResult search(colored_graph::ColoredGraph& graph,
                                   colored_graph::VertexId start, colored_graph::VertexId goal,
                                   const colored_graph::CostModel&,
                                   const colored_graph::SearchOptions& options) override {
    ++m_searches;
    std::map<colored_graph::VertexId, colored_graph::Incidence> before;
    std::deque<colored_graph::VertexId> next{start};
    while (!next.empty() && !before.count(goal)) {
      const colored_graph::VertexId v = next.front();
      next.pop_front();
      for (const colored_graph::Incidence& i : graph.incident(v))
        if (i.neighbor != start && !before.count(i.neighbor) && options.evaluate(i.edge)) {
          before[i.neighbor] = {v, i.edge};
          next.push_back(i.neighbor);
        }
    }
    colored_graph::PathResult result;
    if (!before.count(goal)) return result;
    result.status = colored_graph::SearchStatus::Found;
    result.lengthPerClass.resize(static_cast<std::size_t>(graph.classes()));
    result.vertices = {goal};
    for (auto v = goal; v != start; v = before[v].neighbor) {
      result.vertices.push_back(before[v].neighbor);
      result.edges.push_back(before[v].edge);
      const auto profile = options.evaluate(before[v].edge);
      for (const auto& stretch : *profile) result.lengthPerClass[stretch.classId] += stretch.length;
    }
    std::reverse(result.vertices.begin(), result.vertices.end());
    std::reverse(result.edges.begin(), result.edges.end());
    return result;
  }

 private:
  int& m_searches;
};

}  // namespace

TEST_F(PlannerTest, anotherSearchOfTheGraphTakesThePlaceOfTheUsualOne) {
  paintCorner();
  const std::size_t usual = plan().vertices.size();
  int searches = 0;
  options.graphSearch = [&searches] { return std::make_unique<FewestEdges>(searches); };
  SemanticPlanner p = planner();
  const PlanResult first = p.plan(start, goal);
  expectDrivable(first);
  EXPECT_LT(first.vertices.size(), usual);
  start = first.vertices[1];
  const PlanResult rest = p.replan(start);
  expectDrivable(rest);
  EXPECT_LE(rest.vertices.size(), first.vertices.size() - 1);
  EXPECT_EQ(searches, 2);
}

TEST_F(PlannerTest, takesTheStraightLineWhereClassesAreEqual) {
  paintCorner();
  order = {5, {{1, 2}, {4}, {0}}};
  const PlanResult result = plan();
  expectDrivable(result);
  EXPECT_LT(result.length, 38);
  EXPECT_GT(meters(result, PaintedWorld::Grass), 15);
}

TEST_F(PlannerTest, everyKindOfGraphFindsADrivablePath) {
  paintCorner();
  for (const GraphKind kind :
       {GraphKind::Compressed, GraphKind::Leaves, GraphKind::Halton, GraphKind::HaltonDrivable}) {
    options.roadmap.kind = kind;
    expectDrivable(plan());
  }
}

TEST_F(PlannerTest, leavesAsPublishedHaveOnePointInTheirMiddleAtMost) {
  paintCorner();
  options.roadmap.kind = GraphKind::Leaves;
  options.roadmap.vertices = 0;  // all
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const Ground& ground = p.ground();
  std::set<std::array<int, 2>> middles;
  for (const auto& leaf : semantic_octree::Abstraction(map()).leaves())
    middles.insert({leaf.lowest.x() + leaf.edge() / 2, leaf.lowest.y() + leaf.edge() / 2});
  std::set<std::array<int, 2>> seen;
  std::size_t inMiddles = 0;
  for (colored_graph::VertexId v = 0; v < p.roadmap().graph().vertexIdEnd(); ++v) {
    if (!p.roadmap().graph().containsVertex(v)) continue;
    const TPose2D pose = p.roadmap().pose(v).pose;
    if (pose == start || pose == goal) continue;
    const Column c = ground.columnAt(pose.x, pose.y);
    EXPECT_TRUE(seen.insert({c.x, c.y}).second) << "two vertices at " << c.x << " " << c.y;
    inMiddles += middles.count({c.x, c.y});
  }
  EXPECT_GT(inMiddles, 50u);
  EXPECT_EQ(inMiddles, seen.size());
}

TEST_F(PlannerTest, drivesBelowABridgeAndOverIt) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.box(-2, 2, -14, 14, 3, 3.2, PaintedWorld::Road);
  world.map({-14, 0.05, 2});
  start = {-10, 0, 0};
  goal = {10, 0, 0};
  expectDrivable(plan());
  SemanticPlanner p = planner();
  const PlanResult above = p.plan({0, -12, M_PI / 2}, {0, 12, M_PI / 2}, 3.0, 3.0);
  ASSERT_TRUE(above.found()) << above.reason;
  for (const PathPoint& point : above.path) EXPECT_NEAR(point.z, 3.1, 0.05);
  EXPECT_EQ(p.plan({0, -12, M_PI / 2}, {0, 12, M_PI / 2}, 0.0, 3.0).status,
            PlanStatus::NotConnected);
}

TEST_F(PlannerTest, countsUnknownGroundAsAClassOfItsOwn) {
  world.floor(-10, 10, -10, -1, PaintedWorld::Road);
  world.floor(-10, 10, 1, 10, PaintedWorld::Grass);
  start = {-5, -5, 0};
  goal = {5, 5, 0};
  const PlanResult across = plan();
  expectDrivable(across);
  EXPECT_GE(across.lengthPerClass[semantic_types::kNoClass], 1.9);
  order = {5, {{1}, {2}, {4}}};
  EXPECT_EQ(plan().status, PlanStatus::OnlyForbidden);
}

TEST_F(PlannerTest, takesTheWorseClassUnderTheWheels) {
  world.floor(-10, 10, -10, 10, PaintedWorld::Road);
  world.floor(-10, 10, 0.1, 0.3, PaintedWorld::Mud);  // a rut that one wheel would follow
  start = {-9, 0, 0};
  goal = {9, 0, 0};
  const PlanResult result = plan();
  expectDrivable(result);
  EXPECT_LT(meters(result, PaintedWorld::Mud), 6);
  EXPECT_GT(meters(result, PaintedWorld::Mud), 0);
}

TEST_F(PlannerTest, verticesHeadAlongTheRoadBothWays) {
  paintCorner();
  options.roadmap.vertices = 2000;
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const Roadmap& roadmap = p.roadmap();
  int onRoad = 0, along = 0, opposite = 0;
  for (colored_graph::VertexId v = 2; v < roadmap.graph().vertexIdEnd(); ++v) {
    if (!roadmap.graph().containsVertex(v)) continue;
    const TPose2D& a = roadmap.pose(v).pose;
    if (a.y > 3 || std::abs(a.x + 10) > 1) continue;  // in the road along y
    ++onRoad;
    along += std::abs(std::cos(a.phi)) < 0.3;
    for (colored_graph::VertexId w = 0; w < roadmap.graph().vertexIdEnd(); ++w) {
      if (!roadmap.graph().containsVertex(w)) continue;
      const TPose2D& b = roadmap.pose(w).pose;
      opposite += a.x == b.x && a.y == b.y && std::cos(a.phi - b.phi) < -0.999;
    }
  }
  EXPECT_GT(onRoad, 20);
  EXPECT_GE(along, 0.9 * onRoad);
  EXPECT_GE(opposite, 0.95 * onRoad);  // where the footprint fits both ways
}

TEST_F(PlannerTest, moreVerticesHaveMoreNeighbors) {
  paintCorner();
  options.roadmap.kind = GraphKind::HaltonDrivable;
  const auto edgesPerVertex = [&](std::size_t vertices) {
    options.roadmap.vertices = vertices;
    return plan().numEdges / double(vertices);
  };
  EXPECT_GT(edgesPerVertex(2000), 1.4 * edgesPerVertex(1000));  // 16 neighbors, and 10
}

TEST_F(PlannerTest, verticesAndEdgesStayWithinTheirBudgets) {
  paintCorner();
  for (const GraphKind kind : {GraphKind::Compressed, GraphKind::HaltonDrivable}) {
    options.roadmap.kind = kind;
    options.roadmap.vertices = 300;
    options.roadmap.maxEdges = 900;
    const PlanResult result = plan();
    EXPECT_EQ(result.numVertices, 302u);  // with start and goal
    EXPECT_GE(result.numEdges, 900u);
    EXPECT_LE(result.numEdges, 900u + 4 * options.roadmap.neighbors + 1);
  }
}
