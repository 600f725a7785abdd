#include <gtest/gtest.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include "../semantic_planning/PaintedWorld.h"
#include "OmplProblem.h"

using namespace planning_study;

TEST(StudyPeers, statesAreDrawnBetweenStartAndGoalToo) {
  PaintedWorld world;
  world.floor(-12, 12, -12, 12, PaintedWorld::Grass);
  semantic_planning::PlannerOptions options;
  options.roadmap.kind = semantic_planning::GraphKind::Halton;
  const colored_graph::ClassOrder order(5, {{1}, {2}, {4}, {0}});
  const semantic_planning::SemanticPlanner planner(world.map(), order, options);
  const OmplProblem problem(planner, {{-8, 0, 0}, {8, 0, 0}});

  const auto objective = problem.definition->getOptimizationObjective();
  const auto* start = problem.definition->getStartState(0);
  const auto* goal = problem.definition->getGoal()->as<ompl::base::GoalState>()->getState();
  const auto least = objective->motionCostHeuristic(start, goal);
  EXPECT_NEAR(least.value(), 16, 1e-6);
  const auto sampler = objective->allocInformedStateSampler(problem.definition, 1000);
  ompl::base::ScopedState<> drawn(problem.space);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(sampler->sampleUniform(drawn.get(), least, objective->infiniteCost()));
    near += problem.space->distance(start, drawn.get()) < least.value();
  }
  EXPECT_GT(near, 30);
}
