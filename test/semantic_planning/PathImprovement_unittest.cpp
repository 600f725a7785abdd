#include <algorithm>
#include <cmath>

#include "PlannerFixture.h"
#include "TemporaryFolder.h"

using namespace semantic_planning;

namespace {

/** A wall's outline on the ground, meters. */
struct Wall {
  double west, east, south, north;
};

int gearChanges(const PlanResult& plan) {
  int changes = 0;
  for (std::size_t i = 1; i < plan.path.size(); ++i)
    changes += plan.path[i].forward != plan.path[i - 1].forward;
  return changes;
}

/** Points of the borders of walls, every 2 cm. */
std::vector<Eigen::Vector2d> bordersOf(const std::vector<Wall>& walls) {
  std::vector<Eigen::Vector2d> points;
  for (const Wall& wall : walls) {
    for (double x = wall.west; x <= wall.east; x += 0.02)
      for (const double y : {wall.south, wall.north}) points.emplace_back(x, y);
    for (double y = wall.south; y <= wall.north; y += 0.02)
      for (const double x : {wall.west, wall.east}) points.emplace_back(x, y);
  }
  return points;
}

/** The least distance of a footprint from points along a path, looked at every 2 cm: knows neither
 * discs nor columns. */
double leastClearance(const PlanResult& plan, const Footprint& footprint,
                      const std::vector<Eigen::Vector2d>& points) {
  double least = 100;
  for (std::size_t i = 1; i < plan.path.size(); ++i) {
    const PathPoint &a = plan.path[i - 1], &b = plan.path[i];
    const double turn = std::remainder(b.heading - a.heading, 2 * M_PI);
    for (double t = 0; t < 1; t += 0.02 / std::max(0.02, b.arcLength - a.arcLength)) {
      const Eigen::Vector2d at(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y));
      const Eigen::Rotation2Dd toVehicle(-a.heading - t * turn);
      for (const Eigen::Vector2d& p : points)
        if ((p - at).squaredNorm() < 4)
          least = std::min(least, footprint.distance(toVehicle * (p - at)));
    }
  }
  return least;
}

}  // namespace

class PathImprovementTest : public PlannerTest {
 protected:
  PathImprovementTest() { options.shorten = true; }

  void paintWall(const Wall& wall) {
    world.box(wall.west, wall.east, wall.south, wall.north, 0, 2, PaintedWorld::Wall);
    walls.push_back(wall);
  }

  std::vector<Wall> walls;
};

TEST_F(PathImprovementTest, anImprovedPathIsDrivableAndNeverWorse) {
  paintCorner();
  for (unsigned seed = 0; seed < 2; ++seed) {
    options.roadmap.kind = seed % 2 ? GraphKind::Compressed : GraphKind::HaltonDrivable;
    options.roadmap.seed = seed;
    options.shorten = false;
    const PlanResult asFound = plan();
    options.shorten = true;
    const PlanResult improved = plan();
    expectDrivable(improved);
    EXPECT_LT(improved.price, asFound.price);
  }
}

TEST_F(PathImprovementTest, whereNothingIsInTheWayThePathIsAlmostTheShortest) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  const PlanResult result = plan();
  expectDrivable(result);
  const double shortest = ReedsShepp(options.vehicle.turningRadius).distance(start, goal);
  EXPECT_LT(result.length, 1.02 * shortest);
  EXPECT_EQ(metersBackwards(result), 0);
}

TEST_F(PathImprovementTest, pathsThatAreCountedInEdgesAreLeftAsTheyAre) {
  paintCorner();
  options.cost = colored_graph::CostKind::Count;
  const PlanResult result = plan();
  EXPECT_GT(result.numVertices, 0u);
  options.shorten = false;
  EXPECT_EQ(plan().cost, result.cost);
}

TEST_F(PathImprovementTest, aWayAroundTheCornerIsDrivenForwardKeepsToTheRoadAndSeldomSteers) {
  paintCorner();
  const PlanResult result = plan();
  expectDrivable(result);
  EXPECT_EQ(metersBackwards(result), 0);
  EXPECT_LE(meters(result, PaintedWorld::Grass), 0.2);
  EXPECT_LE(steeringChanges(result.path), 0.15 * result.length);
}

TEST_F(PathImprovementTest, whatADirectionCostsDecidesHowAGoalBehindIsReached) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  start = {0, 0, 0};
  goal = {-4, 0, 0};
  options.vehicle.reverseWeight = 1;
  options.vehicle.gearChange = 0;
  const PlanResult cheap = plan();
  expectDrivable(cheap);
  EXPECT_NEAR(metersBackwards(cheap), 4, 0.1);
  options.vehicle.reverseWeight = 100;
  const PlanResult dear = plan();
  expectDrivable(dear);
  EXPECT_LT(metersBackwards(dear), 1);
  EXPECT_GT(dear.length, 8);
}

TEST_F(PathImprovementTest, aVehicleThatOnlyDrivesForwardDoes) {
  paintCorner();
  options.vehicle.reverseWeight = std::numeric_limits<double>::infinity();
  for (const bool shorten : {false, true}) {
    options.shorten = shorten;
    SemanticPlanner p = planner();
    PlanResult result = p.plan(start, goal);
    for (int i = 0; i < 2; ++i) {
      expectDrivable(result);
      EXPECT_EQ(metersBackwards(result), 0);
      result = p.replan(start);
    }
  }
  goal = {-10, -14, M_PI / 2};  // behind the start, where there is no room to turn
  options.roadmap.vertices = 50;
  const PlanResult behind = plan();
  EXPECT_EQ(metersBackwards(behind), 0);
}

TEST_F(PathImprovementTest, clearanceIsKeptAllAlongThePath) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  for (const double x : {-6.0, 0.0, 6.0}) {
    const double gap = x == 0 ? -6 : 4;
    paintWall({x, x + 0.4, -15, gap});
    paintWall({x, x + 0.4, gap + 2.4, 15});
  }
  start = {-12, -10, 0.7};
  goal = {12, 10, 0.3};
  for (const auto& [radius, clearance] : {std::pair(0.6, 0.2), {1.0, 0.05}, {1.7, 0.1}}) {
    options.vehicle.turningRadius = radius;
    options.vehicle.clearance = clearance;
    const PlanResult result = plan();
    expectDrivable(result);
    EXPECT_GE(leastClearance(result, options.vehicle.footprint, bordersOf(walls)), clearance)
        << radius;
  }
}

TEST_F(PathImprovementTest, aPathIsFoundBesideTheGuideWhereTheRoadmapHasNone) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  for (int i = 0; i < 7; ++i) {  // a slalom
    const double x = -12 + 4 * i;
    paintWall({x, x + 0.4, i % 2 ? -15.0 : -12.0, i % 2 ? 12.0 : 15.0});
  }
  start = {-14, 0, M_PI / 2};
  goal = {14, 0, M_PI / 2};
  options.roadmap.vertices = 12;
  options.shorten = false;
  EXPECT_FALSE(plan().found());
  options.shorten = true;
  const PlanResult result = plan();
  expectDrivable(result);
  EXPECT_EQ(result.numVertices, 0u);
  EXPECT_LE(gearChanges(result), 2);
}

TEST_F(PathImprovementTest, thePriceIsMotionCostAndTheRatesOfTheClasses) {
  paintCorner();
  world.floor(-9, -2, -4, 2, PaintedWorld::Mud);
  order = order.withRates({3, 7, 20});
  for (const bool shorten : {false, true}) {
    options.shorten = shorten;
    const PlanResult result = plan();
    expectDrivable(result);
    EXPECT_NEAR(result.price,
                MotionCost(options.vehicle).of(result.path) +
                    3 * meters(result, PaintedWorld::Grass) + 7 * meters(result, PaintedWorld::Mud),
                1e-3);
  }
}

TEST_F(PathImprovementTest, aStripThatIsHardlyThereIsNoReasonForALongDetourUnlessTheOrderIsStrict) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Wall);  // forbidden, and flat
  world.floor(-14, 14, -14, -10, PaintedWorld::Road);
  world.floor(-14, -10, -14, 14, PaintedWorld::Road);  // a detour around three sides
  world.floor(-14, 14, 10, 14, PaintedWorld::Road);
  world.floor(10, 14, -14, 14, PaintedWorld::Road);
  world.floor(0, 0.2, -14, -10, PaintedWorld::Grass);
  start = {-5, -12, 0};
  goal = {5, -12, 0};
  const PlanResult usual = plan();
  expectDrivable(usual);
  EXPECT_LT(usual.length, 12);
  EXPECT_GT(meters(usual, PaintedWorld::Grass), 0);
  options.strict = true;
  const PlanResult strict = plan();
  expectDrivable(strict);
  EXPECT_EQ(meters(strict, PaintedWorld::Grass), 0);
  EXPECT_GT(strict.length, 60);
}

TEST_F(PathImprovementTest, higherRatesOfAClassNeverGiveMoreOfIt) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  world.floor(-1, 1, -15, 13, PaintedWorld::Grass);
  start = {-12, -6, 0};
  goal = {12, 6, 0};
  double last = 30;
  for (const double rate : {0., 1., 4., 20.}) {
    order = order.withRates({rate, 100, 200});
    const PlanResult result = plan();
    expectDrivable(result);
    EXPECT_LE(meters(result, PaintedWorld::Grass), last + 0.05) << rate;
    last = meters(result, PaintedWorld::Grass);
  }
  EXPECT_EQ(last, 0);
}

TEST_F(PathImprovementTest, whereNothingCanBeReachedItSaysWhatCan) {
  paintCorner();
  SemanticPlanner p = planner();
  ASSERT_TRUE(p.plan(start, goal).found());
  EXPECT_FALSE(p.hasRoadmap());
  EXPECT_TRUE(p.hasPlanned());
  world.box(-13, 14, 4, 4.4, 0, 2, PaintedWorld::Wall).map();
  world.box(-15, -12.9, 4, 4.4, 0, 2, PaintedWorld::Wall).map();
  world.box(13, 15, 4, 4.4, 0, 2, PaintedWorld::Wall).map();
  p.update();
  const PlanResult none = p.replan(start);
  EXPECT_EQ(none.status, PlanStatus::NotConnected);
  EXPECT_FALSE(p.hasRoadmap());
  ASSERT_TRUE(none.obstacle);
  EXPECT_NEAR(none.obstacle->y, 3.5, 0.6);
  EXPECT_TRUE(contains(none.reason, "m from the goal")) << none.reason;
}

TEST_F(PathImprovementTest, whoIsOnAPathThatIsFreeKeepsIt) {
  paintCorner();
  SemanticPlanner p = planner();
  const PlanResult first = p.plan(start, goal);
  const PathPoint& ahead = first.path[first.path.size() / 3];
  start = {ahead.x, ahead.y, ahead.heading};
  const auto expectRest = [&](const PlanResult& rest) {
    expectDrivable(rest);
    EXPECT_NEAR(rest.length, first.length - ahead.arcLength, 0.02);
    EXPECT_NEAR(rest.price,
                MotionCost(options.vehicle).of(rest.path) + 4 * meters(rest, PaintedWorld::Grass),
                1e-6);
    for (const auto& [stage, ms] : rest.times) EXPECT_NE(stage, "beside");
  };
  expectRest(p.replan(start));
  world.box(3, 4, -9, -8, 0, 2, PaintedWorld::Wall).map();  // far from it
  p.update();
  expectRest(p.replan(start));
}

TEST_F(PathImprovementTest, whatStandsOnAPathOrSparesMetersEndsIt) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Road);
  world.floor(-1, 1, -15, 15, PaintedWorld::Mud);
  start = {-12, 0, 0};
  goal = {12, 0, 0};
  SemanticPlanner p = planner();
  const PlanResult across = p.plan(start, goal);
  expectDrivable(across);
  world.box(-5, -4.6, -4, 4, 0, 2, PaintedWorld::Wall).map();
  p.update();
  const PlanResult around = p.replan(start);
  expectDrivable(around);
  EXPECT_GT(around.price, across.price + 0.5);
  for (int i = 0; i < 6; ++i) world.floor(-1, 1, 7, 10, PaintedWorld::Road).map();
  p.update();
  const PlanResult spared = p.replan(start);
  expectDrivable(spared);
  EXPECT_LT(spared.price, around.price - 5);
}
