#include "PlannerFixture.h"

using namespace semantic_planning;

TEST_F(PlannerTest, aShortenedPathIsDrivableAndNeverWorse) {
  paintCorner();
  for (unsigned seed = 0; seed < 2; ++seed) {
    options.roadmap.kind = seed % 2 ? GraphKind::Compressed : GraphKind::HaltonDrivable;
    options.roadmap.seed = seed;
    options.shorten = false;
    const PlanResult asFound = plan();
    options.shorten = true;
    const PlanResult shortened = plan();
    expectDrivable(shortened);
    EXPECT_EQ(asFound.cost, asFound.roadmapCost);
    EXPECT_EQ(shortened.roadmapCost, asFound.cost);
    EXPECT_LT(shortened.cost, asFound.cost);
  }
}

TEST_F(PlannerTest, whereNothingIsInTheWayAShortenedPathIsAlmostTheShortest) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  options.shorten = true;
  const PlanResult result = plan();
  expectDrivable(result);
  const double shortest = ReedsShepp(options.vehicle.turningRadius).distance(start, goal);
  EXPECT_LT(result.length, 1.03 * shortest);
}

TEST_F(PlannerTest, pathsThatAreCountedInEdgesAreLeftAsTheyAre) {
  paintCorner();
  options.shorten = true;
  options.cost = colored_graph::CostKind::Count;
  const PlanResult result = plan();
  EXPECT_EQ(result.cost, result.roadmapCost);
}

TEST_F(PlannerTest, aPathThatOnlyBecomesShorterGetsNoMoreGearChanges) {
  world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
  const auto gearChanges = [](const PlanResult& plan) {
    int changes = 0;
    for (std::size_t i = 1; i < plan.path.size(); ++i)
      changes += plan.path[i].forward != plan.path[i - 1].forward;
    return changes;
  };
  options.roadmap.vertices = 150;
  options.vehicle.turningRadius = 2.5;
  int less = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    options.roadmap.seed = seed;
    goal = {-10 + 1.5 * seed, 4, 2.0 * seed};
    options.shorten = false;
    const PlanResult asFound = plan();
    options.shorten = true;
    const PlanResult shortened = plan();
    expectDrivable(shortened);
    EXPECT_LE(gearChanges(shortened), gearChanges(asFound)) << "seed " << seed;
    less += shortened.length < asFound.length;
  }
  EXPECT_GT(less, 3);
}
