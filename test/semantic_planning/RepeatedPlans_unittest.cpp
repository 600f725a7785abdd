// What a planner keeps between plans must not show in its answers: they are those of a planner that
// is made for each.
#include <semantic_abstraction/Abstraction.h>

#include <random>

#include "PlannerFixture.h"

using namespace semantic_planning;

namespace {

std::vector<double> numbersOf(const PlanResult& plan) {
  std::vector<double> numbers = {
      double(plan.status), double(plan.numVertices),       double(plan.numEdges),
      plan.length,         double(plan.search.expansions), double(plan.search.edgesEvaluated)};
  numbers.insert(numbers.end(), plan.cost.begin(), plan.cost.end());
  numbers.insert(numbers.end(), plan.lengthPerClass.begin(), plan.lengthPerClass.end());
  for (const PathPoint& p : plan.path)
    for (const double n :
         {p.x, p.y, p.z, p.heading, p.curvature, double(p.forward), double(p.classId), p.arcLength})
      numbers.push_back(n);
  return numbers;
}

class RepeatedPlansTest : public PlannerTest {
 protected:
  double coordinate() { return double(m_random() % 260) / 10 - 13; }

  /** Squares of another class that one scan does not always turn, walls, another compressed tree.
   */
  void changeMap() {
    const double x = coordinate(), y = coordinate();
    const auto id = m_random() % 2 ? PaintedWorld::Mud : PaintedWorld::Road;
    for (unsigned i = m_random() % 3; i < 3; ++i) {
      world.floor(x - 2, x + 2, y - 2, y + 2, id);
      if (m_random() % 3 == 0) world.box(x, x + 1, y - 1, y + 1, 0, 1, PaintedWorld::Wall);
      world.map();
    }
    if (m_random() % 3 == 0)
      semantic_octree::Abstraction(world.map()).setAlpha(m_random() % 2 ? 0.005 : 0.1);
  }
  void expectAnswersOfFreshPlanners(int rounds) {
    paintCorner();
    options.roadmap.vertices = 200;
    SemanticPlanner kept = planner();
    for (int round = 0; round < rounds; ++round) {
      const TPose2D from = round % 2 ? start : TPose2D(coordinate(), coordinate(), 1.0 * round);
      const TPose2D to = round % 3 ? goal : TPose2D(coordinate(), coordinate(), 2.0 * round);
      const PlanResult plan = kept.plan(from, to);
      found += plan.found();
      ASSERT_EQ(numbersOf(plan), numbersOf(planner().plan(from, to))) << "round " << round;
      if (round % 4 == 3) continue;  // and once more in the same map
      changeMap();
      if (m_random() % 2) kept.update();
      if (plan.found() && m_random() % 2) kept.replan(from);
    }
  }

  int found = 0;

 private:
  std::mt19937 m_random{5};
};

TEST_F(RepeatedPlansTest, planAsFreshPlannersDoWhateverWasBefore) {
  expectAnswersOfFreshPlanners(16);
  EXPECT_GT(found, 8);
}

TEST_F(RepeatedPlansTest, improvePathsAsFreshPlannersDo) {
  options.shorten = true;
  expectAnswersOfFreshPlanners(10);
}

TEST_F(RepeatedPlansTest, planAsFreshPlannersDoForAVehicleThatOnlyDrivesForward) {
  options.vehicle.reverseWeight = std::numeric_limits<double>::infinity();
  expectAnswersOfFreshPlanners(8);
}

TEST_F(RepeatedPlansTest, planAsFreshPlannersDoInMapsWithLargeLeaves) {
  options.edges = colored_graph::EdgeModel::Endpoint;
  auto abstraction = abstractionFor(order);
  abstraction.blockSize = 12.8;
  setAbstraction(world.map(), abstraction);
  expectAnswersOfFreshPlanners(8);
}

TEST_F(RepeatedPlansTest, whatIsForgottenIsFoundOutAgain) {
  paintCorner();
  SemanticPlanner p = planner();
  const PlanResult first = p.plan(start, goal);
  p.forget();
  EXPECT_FALSE(p.hasRoadmap());
  const PlanResult again = p.plan(start, goal);
  EXPECT_EQ(numbersOf(again), numbersOf(first));
}

class SlicedPlansTest : public PlannerTest {
 protected:
  SlicedPlansTest() {
    options.shorten = true;
    paintCorner();
  }
  /** \param slices their number is added */
  static PlanResult finished(SemanticPlanner& p, int& slices) {
    for (;; ++slices) {
      std::size_t work = kSlice;
      if (auto plan = p.goOn(work)) return *plan;
      EXPECT_EQ(work, 0u) << "there was nothing left to do";
    }
  }
  static void goOnOnce(SemanticPlanner& p) {
    std::size_t work = kSlice;
    ASSERT_FALSE(p.goOn(work));
  }

  static constexpr std::size_t kSlice = 1000;
};

}  // namespace

TEST_F(SlicedPlansTest, areThoseInOneGo) {
  SemanticPlanner whole = planner(), p = planner();
  int slices = 0;
  p.begin(start, goal);
  EXPECT_EQ(numbersOf(finished(p, slices)), numbersOf(whole.plan(start, goal)));
  EXPECT_GT(slices, 3);
  world.box(-12, -8, 0, 1, 0, 1, PaintedWorld::Wall).map();
  whole.update();
  p.update();
  p.begin(start, {});
  EXPECT_EQ(numbersOf(finished(p, slices)), numbersOf(whole.replan(start)));
  p.begin({-10, 30, 0}, goal);
  EXPECT_EQ(finished(p, slices).status, PlanStatus::StartOffGround);
}

TEST_F(SlicedPlansTest, wayThatIsBlockedMeanwhileIsLookedForAnew) {
  SemanticPlanner p = planner();
  p.begin(start, goal);
  goOnOnce(p);
  world.box(-14, -6, 0, 1, 0, 1, PaintedWorld::Wall).map();
  p.update();
  int slices = 0;
  expectDrivable(finished(p, slices));
}

TEST_F(SlicedPlansTest, canBeGivenUp) {
  const PlanResult whole = plan();
  SemanticPlanner p = planner();
  p.begin(goal, start);
  goOnOnce(p);
  EXPECT_EQ(numbersOf(p.plan(start, goal)), numbersOf(whole));
  std::size_t work = kSlice;
  EXPECT_THROW(p.goOn(work), std::logic_error);
  p.begin(start, TPose2D{goal});
  p.forget();
  EXPECT_THROW(p.begin(start, {}), std::logic_error);
  p.begin(start, goal);
  goOnOnce(p);  // the planner goes before the search ends
}

TEST_F(SlicedPlansTest, throwWhatTheSearchThrows) {
  options.cancelled = []() -> bool { throw std::runtime_error("out of order"); };
  SemanticPlanner p = planner();
  p.begin(start, goal);
  std::size_t work = kSlice;
  EXPECT_THROW(p.goOn(work), std::runtime_error);
  EXPECT_THROW(p.goOn(work), std::logic_error);
}
