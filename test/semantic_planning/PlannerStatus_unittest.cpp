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
  options.roadmap.kind = GraphKind::Halton;
  EXPECT_NO_THROW(SemanticPlanner(world.map(), order, options));
}

TEST_F(PlannerTest, thereIsNothingToReplanBeforeAPlan) {
  paintCorner();
  SemanticPlanner p = planner();
  EXPECT_THROW(p.replan(start), std::logic_error);
  EXPECT_THROW(p.roadmap(), std::logic_error);
}

namespace {

/** A road of 24 x 24 m, of which nothing is known in the middle. */
void paintAround(PaintedWorld& world, double hole) {
  world.floor(-12, -hole, -12, 12, PaintedWorld::Road);
  world.floor(hole, 12, -12, 12, PaintedWorld::Road);
  world.floor(-hole, hole, -12, -hole, PaintedWorld::Road);
  world.floor(-hole, hole, hole, 12, PaintedWorld::Road);
}

}  // namespace

TEST_F(PlannerTest, aVehicleStandsOnTheGroundThatIsAroundItWhereTheMapKnowsNone) {
  paintAround(world, 3);
  SemanticPlanner p = planner();
  const TPose2D middle{0, 0, 0.3}, seen{-8, -8, 0}, ahead{8, 0, 0};
  const auto isKnown = [&] {
    return !p.ground().surfaces(p.ground().columnAt(middle.x, middle.y)).empty();
  };
  EXPECT_FALSE(isKnown());
  for (int i = 0; i < 2; ++i) {
    const PlanResult plan = p.plan(middle, ahead);
    ASSERT_TRUE(plan.found()) << plan.reason;
    EXPECT_NEAR(meters(plan, PaintedWorld::Road), plan.length, 0.01);
    EXPECT_LT(plan.length, 9);
    EXPECT_TRUE(p.replan(middle).found());
    const auto below = p.ground().find(middle.x, middle.y);
    ASSERT_TRUE(below);
    EXPECT_NEAR(p.ground().centerOf(below->surface.z), -0.1, 1e-6);
    ASSERT_TRUE(p.plan(seen, ahead).found());
    EXPECT_FALSE(isKnown()) << "of an earlier start nothing is left";
    EXPECT_EQ(p.plan(seen, middle).status, PlanStatus::GoalOffGround);
  }
}

TEST_F(PlannerTest, groundThatAnEarlierStartHadBelowIsFreeNoLonger) {
  paintAround(world, 3);
  options.shorten = true;
  SemanticPlanner p = planner();
  const TPose2D from{3.3, -5, M_PI / 2}, to{3.3, 5, M_PI / 2};
  ASSERT_TRUE(p.plan({0, 0, 0.3}, {8, 0, 0}).found());
  EXPECT_EQ(p.plan(from, to).length, planner().plan(from, to).length);
}

TEST_F(PlannerTest, aVehicleStandsOnASlopeAsTheGroundAroundItDoes) {
  constexpr double kSlope = 0.3;
  for (double x = -12; x < 12; x += 0.2)
    for (double y = -12; y < 12; y += 0.2)
      if (std::abs(x) > 3 || std::abs(y) > 3)
        world.box(x, x + 0.2, y, y + 0.2, kSlope * x - 0.1, kSlope * x + 0.1, PaintedWorld::Road);
  SemanticPlanner p = planner();
  const PlanResult plan = p.plan({-1.5, 0.5, 0}, {8, 0, 0});
  ASSERT_TRUE(plan.found()) << plan.reason;
  for (const double x : {-2.1, -0.5})
    EXPECT_NEAR(p.ground().centerOf(p.ground().find(x, 0.5)->surface.z), kSlope * x, 0.2);
}

TEST_F(PlannerTest, beyondTheBorderOfWhatIsKnownAVehicleStandsOnNothing) {
  paintAround(world, 3);
  const PlanResult plan = planner().plan({-13.5, 0, 0}, {8, 0, 0});
  EXPECT_EQ(plan.status, PlanStatus::StartOffGround);
  EXPECT_TRUE(contains(plan.reason, "ground not known")) << plan.reason;
}

TEST_F(PlannerTest, whereAllGroundAroundIsForbiddenAVehicleStandsOnNothing) {
  order = colored_graph::ClassOrder(5, {{1}, {2}, {4}});  // unknown ground, too
  world.floor(-12, 12, -12, -3, PaintedWorld::Wall);
  world.floor(-12, 12, 3, 12, PaintedWorld::Wall);
  world.floor(-12, -3, -3, 3, PaintedWorld::Wall);
  world.floor(3, 12, -3, 3, PaintedWorld::Wall);
  EXPECT_EQ(planner().plan({0, 0, 0}, {8, 0, 0}).status, PlanStatus::StartOffGround);
}
