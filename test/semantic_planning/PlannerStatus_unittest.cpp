#include "PlannerFixture.h"
#include "TemporaryFolder.h"

using namespace semantic_planning;

TEST_F(PlannerTest, saysWhyAStartOrGoalWillNotDo) {
  paintCorner();
  world.box(-10.4, -9.6, -13.4, -12.6, 0, 2, PaintedWorld::Wall);
  world.floor(4, 8, -8, -4, PaintedWorld::Wall);  // forbidden, and flat
  SemanticPlanner p = planner();
  const TPose2D inWall = start, nearWall{-10, -12.4, 0}, outside{100, 0, 0}, forbidden{6, -6, 0};
  EXPECT_EQ(p.plan(inWall, goal).status, PlanStatus::StartBlocked);
  EXPECT_EQ(p.plan(nearWall, goal).status, PlanStatus::StartBlocked);
  EXPECT_EQ(p.plan(outside, goal).status, PlanStatus::StartOffGround);
  EXPECT_EQ(p.plan(forbidden, goal).status, PlanStatus::StartForbidden);
  EXPECT_EQ(p.plan(goal, nearWall).status, PlanStatus::GoalBlocked);
  EXPECT_EQ(p.plan(goal, outside).status, PlanStatus::GoalOffGround);
  const PlanResult result = p.plan(goal, forbidden);
  EXPECT_EQ(result.status, PlanStatus::GoalForbidden);
  EXPECT_TRUE(contains(result.reason, "the goal (6, -6)")) << result.reason;
  EXPECT_FALSE(p.hasRoadmap());
}

TEST_F(PlannerTest, aRefusalSaysWhatIsInTheWayAndWhere) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.box(4.4, 4.6, -1, 1, 0, 2, PaintedWorld::Wall);
  world.box(-6, -5, -2, 2, -0.2, 0, PaintedWorld::Wall);  // forbidden, and flat
  SemanticPlanner p = planner();
  const PlanResult wall = p.plan({0, -5, 0}, {4, 0, 0});
  EXPECT_TRUE(contains(wall.reason, "m from the goal: an obstacle (wall)")) << wall.reason;
  ASSERT_TRUE(wall.obstacle);
  EXPECT_NEAR(wall.obstacle->x, 4.5, 0.11);
  const PlanResult edge = p.plan({0, -5, 0}, {14.6, 5, 0});
  EXPECT_TRUE(contains(edge.reason, "m from the goal: ground not known")) << edge.reason;
  EXPECT_TRUE(contains(edge.reason, ": (15.1, ")) << edge.reason;
  const PlanResult forbidden = p.plan({-5.5, 0, 0}, {0, 0, 0});
  EXPECT_TRUE(contains(forbidden.reason, "m from the start: ground of wall, which the order"))
      << forbidden.reason;
  EXPECT_FALSE(p.plan({0, -5, 0}, {0, 5, 0}).obstacle);
}

TEST_F(PlannerTest, saysThatAllWaysAreForbidden) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  world.floor(-1, 1, -15, 15, PaintedWorld::Wall);
  start = {-10, 0, 0};
  goal = {10, 0, 0};
  for (const bool shorten : {false, true}) {
    options.shorten = shorten;
    options.ground.keepOff = false;
    EXPECT_EQ(plan().status, PlanStatus::OnlyForbidden) << shorten;
    options.ground.keepOff = true;
    EXPECT_EQ(plan().status, PlanStatus::NotConnected) << shorten;
  }
}

TEST_F(PlannerTest, stopsWhenCancelled) {
  paintCorner();
  options.cancelled = [] { return true; };
  for (const bool shorten : {false, true}) {
    options.shorten = shorten;
    const PlanResult result = plan();
    EXPECT_EQ(result.status, PlanStatus::Cancelled) << shorten;
    EXPECT_TRUE(contains(result.reason, "cancelled")) << result.reason;
  }
}

TEST_F(PlannerTest, onAnEmptyMapTheStartIsOffGround) {
  EXPECT_EQ(plan().status, PlanStatus::StartOffGround);
}

TEST_F(PlannerTest, refusesNumbersThatAreNone) {
  paintCorner();
  SemanticPlanner p = planner();
  EXPECT_THROW(p.plan({NAN, 0, 0}, goal), std::invalid_argument);
  EXPECT_THROW(p.plan(start, {0, INFINITY, 0}), std::invalid_argument);
  EXPECT_THROW(p.plan(start, goal, NAN), std::invalid_argument);
  EXPECT_THROW(p.check({0, 0, NAN}), std::invalid_argument);
}

TEST_F(PlannerTest, refusesBadOptionsNamingThem) {
  paintCorner();
  const auto refusal = [&](void (*spoil)(PlannerOptions&)) {
    PlannerOptions spoiled = options;
    spoil(spoiled);
    return errorOf([&] { SemanticPlanner(map(), order, spoiled); });
  };
  EXPECT_TRUE(contains(refusal([](auto& o) { o.vehicle.turningRadius = 0; }), "turning_radius"));
  EXPECT_TRUE(contains(refusal([](auto& o) { o.roadmap.buffer = NAN; }), "buffer"));
  EXPECT_TRUE(contains(refusal([](auto& o) { o.ground.fillGap = -1; }), "fill_gap is -1"));
}

TEST_F(PlannerTest, aCompressedGraphNeedsAMapWithGValues) {
  paintCorner();
  EXPECT_THROW(SemanticPlanner(world.map(), order, options), std::logic_error);
  options.shorten = true;
  EXPECT_NO_THROW(SemanticPlanner(world.map(), order, options)) << "there is no graph";
  options.shorten = false;
  options.roadmap.kind = GraphKind::Full;
  EXPECT_NO_THROW(SemanticPlanner(world.map(), order, options));
}

TEST_F(PlannerTest, thereIsNothingToReplanBeforeAPlan) {
  paintCorner();
  SemanticPlanner p = planner();
  EXPECT_THROW(p.replan(start), std::logic_error);
  EXPECT_THROW(p.roadmap(), std::logic_error);
}
