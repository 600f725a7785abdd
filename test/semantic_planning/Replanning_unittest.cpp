#include <algorithm>
#include <random>

#include "PlannerFixture.h"

using namespace semantic_planning;
using colored_graph::EdgeId;

namespace {

/** The best cost in a copy of the roadmap's graph whose edges are all evaluated anew. */
std::vector<std::int64_t> costFromScratch(const SemanticPlanner& planner,
                                          const PlannerOptions& options,
                                          const colored_graph::ClassOrder& order,
                                          const PlanResult& plan) {
  const Roadmap& roadmap = planner.roadmap();
  colored_graph::ColoredGraph graph = roadmap.graph();
  for (EdgeId e = 0; e < graph.edgeIdEnd(); ++e) {
    if (!graph.containsEdge(e)) continue;
    if (auto profile = roadmap.evaluate(e))
      graph.setProfile(e, *profile);
    else
      graph.setBlocked(e);
  }
  const auto vertexAt = [&](const mrpt::math::TPose2D& pose) {
    for (colored_graph::VertexId v = 0; v < graph.vertexIdEnd(); ++v)
      if (graph.containsVertex(v) && roadmap.pose(v).pose == pose) return v;
    return colored_graph::kNoVertex;
  };
  const auto from = vertexAt(plan.vertices.front()), to = vertexAt(plan.vertices.back());
  return findColoredPath(graph, from, to, {order, options.edges, options.cost, true}).cost;
}

}  // namespace

TEST_F(PlannerTest, replanningGoesAroundMudThatAppearsOnTheRoad) {
  paintCorner();
  options.roadmap.vertices = 1000;
  SemanticPlanner p = planner();
  ASSERT_EQ(meters(p.plan(start, goal), PaintedWorld::Grass), 0);
  for (int i = 0; i < 6; ++i)
    world.floor(-11.5, -8.5, -2, 2, PaintedWorld::Mud).map();  // until the classes have changed
  p.update();
  const PlanResult after = p.replan(start);
  expectDrivable(after);
  EXPECT_EQ(meters(after, PaintedWorld::Mud), 0);
  EXPECT_GT(meters(after, PaintedWorld::Grass), 3);
  EXPECT_EQ(after.cost, costFromScratch(p, options, order, after));
}

TEST_F(PlannerTest, aMovingStartKeepsTheBestPath) {
  paintCorner();
  SemanticPlanner p = planner();
  PlanResult result = p.plan(start, goal);
  for (int i = 0; i < 3; ++i) {
    const PathPoint& ahead = result.path[result.path.size() / 4];
    start = {ahead.x, ahead.y, ahead.heading};
    result = p.replan(start);
    expectDrivable(result);
    EXPECT_EQ(result.cost, costFromScratch(p, options, order, result));
  }
}

TEST_F(PlannerTest, startAndGoalMayBeOnePlaceAndStayWhereTheyWere) {
  paintCorner();
  SemanticPlanner p = planner();
  const PlanResult there = p.plan(start, start);
  ASSERT_TRUE(there.found()) << there.reason;
  EXPECT_EQ(there.length, 0);
  const PlanResult first = p.plan(start, goal);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(p.replan(start).cost, first.cost);
  EXPECT_EQ(p.replan(goal).length, 0);
}

TEST_F(PlannerTest, afterEveryChangeOfTheMapTheRepairedPathIsTheBest) {
  paintCorner();
  options.roadmap.vertices = 250;
  SemanticPlanner p = planner();
  ASSERT_TRUE(p.plan(start, goal).found());
  std::mt19937 random(11);
  const auto coordinate = [&] { return double(random() % 260) / 10 - 13; };
  int inserted = 0, removed = 0;
  for (int round = 0; round < 6; ++round) {
    const double x = coordinate(), y = coordinate();
    const bool wall = round % 2 && std::hypot(x - start.x, y - start.y) > 4 &&
                      std::hypot(x - goal.x, y - goal.y) > 4;
    for (int i = 0; i < 4; ++i) {
      world.floor(x - 2, x + 2, y - 2, y + 2, round % 3 ? PaintedWorld::Mud : PaintedWorld::Road);
      if (wall) world.box(x, x + 1, y - 1, y + 1, 0, 1, PaintedWorld::Wall);
      world.map();
    }
    const auto before = posesOf(p.roadmap());
    p.update();
    const auto now = posesOf(p.roadmap());
    inserted += !std::includes(before.begin(), before.end(), now.begin(), now.end());
    removed += !std::includes(now.begin(), now.end(), before.begin(), before.end());
    const PlanResult result = p.replan(start);
    expectDrivable(result);
    EXPECT_EQ(result.cost, costFromScratch(p, options, order, result)) << "round " << round;
  }
  EXPECT_GT(inserted, 0);
  EXPECT_GT(removed, 0);
}

TEST_F(PlannerTest, theBudgetOfEdgesHoldsAfterUpdatesAndTheBestOnesAreIn) {
  paintCorner();
  options.roadmap.maxEdges = 700;
  SemanticPlanner p = planner();
  p.plan(start, goal);
  const auto edges = [&](const Roadmap& roadmap) {
    std::set<std::pair<std::vector<double>, std::vector<double>>> all;
    for (EdgeId e = 0; e < roadmap.graph().edgeIdEnd(); ++e) {
      if (!roadmap.graph().containsEdge(e)) continue;
      const PosePair ends = roadmap.ends(e);
      const auto &a = ends.first.pose, &b = ends.second.pose;
      if (a == start || b == start || a == goal || b == goal) continue;
      all.insert({{a.x, a.y, a.phi}, {b.x, b.y, b.phi}});
    }
    return all;
  };
  EXPECT_EQ(edges(p.roadmap()).size(), 700u);
  for (const double x : {-4.0, 3.0}) {
    world.box(x, x + 4, -5, 5, 0, 1, PaintedWorld::Wall).map();
    const auto before = posesOf(p.roadmap());
    p.update();
    EXPECT_NE(posesOf(p.roadmap()), before);
    EXPECT_EQ(edges(p.roadmap()).size(), 700u);
  }
  p.replan(start);
  SemanticPlanner fresh = planner();
  fresh.plan(start, goal);
  EXPECT_EQ(edges(p.roadmap()), edges(fresh.roadmap()));
}
