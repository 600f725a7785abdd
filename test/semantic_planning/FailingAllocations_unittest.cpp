// A planner for which memory ran out says so, whatever it is asked; the map is as it was.
#include "FailingAllocations.h"

#include "PlannerFixture.h"

using namespace semantic_planning;

namespace {

class FailingPlans : public PlannerTest {
 protected:
  FailingPlans() {
    start = {-1.5, 0, 0}, goal = {1.5, 0, 0};
    world.floor(-3, 3, -1.5, 1.5, PaintedWorld::Road);
    options.roadmap.vertices = 8;
    options.vehicle.turningRadius = 0.3;
  }

  void expectBroken(SemanticPlanner& p) {
    EXPECT_THROW(p.plan(start, goal), std::logic_error);
    EXPECT_THROW(p.update(), std::logic_error);
    EXPECT_THROW(p.replan(start), std::logic_error);
    EXPECT_THROW(p.forget(), std::logic_error);
    EXPECT_THROW(p.ground(), std::logic_error);
    EXPECT_THROW(p.roadmap(), std::logic_error);
    EXPECT_THROW(p.check(start), std::logic_error);
  }

  std::optional<SemanticPlanner> planner;
};

}  // namespace

TEST_F(FailingPlans, areThoseOfABrokenPlannerAndTheMapStays) {
  for (const GraphKind kind : {GraphKind::Compressed, GraphKind::HaltonDrivable}) {
    options.roadmap.kind = kind;
    const semantic_octree::SemanticOcTree before = map();
    const PlanResult expected = plan();
    ASSERT_TRUE(expected.found()) << expected.reason;
    PlanResult result;
    const int failures = failEachAllocation([&] { planner.emplace(map(), order, options); },
                                            [&] { result = planner->plan(start, goal); },
                                            [&] {
                                              expectBroken(*planner);
                                              EXPECT_TRUE(map() == before);
                                            });
    EXPECT_GT(failures, 3);
    EXPECT_EQ(result.cost, expected.cost);
  }
}

TEST_F(FailingPlans, whileThePlannerFollowsTheMapBreakItToo) {
  options.shorten = false;
  semantic_octree::SemanticOcTree& m = map();
  const semantic_octree::SemanticOcTree small = m;
  PlanResult result;
  const int failures = failEachAllocation(
      [&] {
        planner.reset();
        m = small;
        planner.emplace(m, order, options);
        planner->plan(start, goal);
        world.floor(-0.5, 0.5, -1.5, 0, PaintedWorld::Mud).map();
      },
      [&] {
        planner->update();
        result = planner->replan(start);
      },
      [&] { expectBroken(*planner); });
  EXPECT_GT(failures, 3);
  EXPECT_TRUE(result.found()) << result.reason;
}

TEST_F(FailingPlans, andWhatMakesOneLeavesTheMap) {
  const semantic_octree::SemanticOcTree before = map();
  EXPECT_GT(failEachAllocation([] {}, [&] { planner.emplace(map(), order, options); },
                               [&] { EXPECT_TRUE(map() == before); }),
            3);
}

TEST_F(FailingPlans, areThoseThatTheirUserBreaksOff) {
  options.cancelled = []() -> bool { throw std::runtime_error("enough"); };
  SemanticPlanner p(map(), order, options);
  EXPECT_THROW(p.plan(start, goal), std::runtime_error);
  expectBroken(p);
}
