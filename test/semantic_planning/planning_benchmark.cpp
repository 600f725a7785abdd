// Planning across a map of 100 m, ground known, in stages; reading the ground; replanning after 1 %
// of the map's columns changed. One core.
#include <benchmark/benchmark.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <memory>

#include "Town.h"

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

PlannerOptions optionsOf(GraphKind kind) {
  PlannerOptions options;  // turning radius 1 m, 1000 vertices
  options.roadmap.kind = kind;
  return options;
}

const TPose2D kStart{-47, -47, M_PI / 2}, kGoal{45, 28, 0}, kNext{-47, 3, M_PI};

void reportStages(benchmark::State& state, const std::map<std::string, double>& sums) {
  for (const auto& [stage, sum] : sums)
    state.counters[stage + "_ms"] = benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
}

void addStages(const StageTimes& times, std::map<std::string, double>& sums) {
  for (const auto& [stage, milliseconds] : times) sums[stage] += milliseconds;
}

void reportPlan(benchmark::State& state, const PlanResult& plan) {
  state.counters["vertices"] = double(plan.numVertices);
  state.counters["edges"] = double(plan.numEdges);
  state.counters["evaluated"] = double(plan.search.edgesEvaluated);
  state.counters["length_m"] = plan.length;
  state.counters["grass_m"] = plan.found() ? plan.lengthPerClass[PaintedWorld::Grass] : -1;
}

void readGround(benchmark::State& state) {
  const PlannerOptions options;
  const semantic_octree::SemanticOcTree& map = town::map();
  for (auto _ : state)
    benchmark::DoNotOptimize(Ground(map, options.vehicle, options.ground, town::order()));
}
BENCHMARK(readGround)->Unit(benchmark::kMillisecond);

/** The last of several plans of a planner that is made for them, that one timed. */
void planLast(benchmark::State& state, const std::vector<std::pair<TPose2D, TPose2D>>& tasks) {
  const auto options = optionsOf(static_cast<GraphKind>(state.range(0)));
  std::map<std::string, double> sums;
  PlanResult result;
  for (auto _ : state) {
    state.PauseTiming();
    auto planner = std::make_unique<SemanticPlanner>(town::map(), town::order(), options);
    for (std::size_t i = 0; i + 1 < tasks.size(); ++i)
      planner->plan(tasks[i].first, tasks[i].second);
    state.ResumeTiming();
    result = planner->plan(tasks.back().first, tasks.back().second);
    state.PauseTiming();
    planner.reset();
    addStages(result.times, sums);
    state.ResumeTiming();
  }
  if (!result.found()) state.SkipWithError(result.reason.c_str());
  reportStages(state, sums);
  reportPlan(state, result);
}

void eachKind(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("kind")
      ->DenseRange(int(GraphKind::Compressed), int(GraphKind::HaltonDrivable))
      ->Unit(benchmark::kMillisecond);
}

void plan(benchmark::State& state) { planLast(state, {{kStart, kGoal}}); }
BENCHMARK(plan)->Apply(eachKind);

/** To another goal, from where the first plan led. */
void planAgain(benchmark::State& state) { planLast(state, {{kStart, kGoal}, {kGoal, kNext}}); }
BENCHMARK(planAgain)->Apply(eachKind);

/** A square of 10 m on the way turns to mud, and back to road. */
void replanAfterOnePercentChanged(benchmark::State& state) {
  PaintedWorld world = town::world();
  semantic_octree::SemanticOcTree& map = world.map({0.05, 0.05, 60});
  setAbstraction(map, abstractionFor(town::order()));
  SemanticPlanner planner(map, town::order(), optionsOf(GraphKind::Compressed));
  planner.plan(kStart, kGoal);
  planner.replan(kStart);
  std::map<std::string, double> sums;
  PlanResult result;
  UpdateResult update;
  bool mud = true;
  for (auto _ : state) {
    state.PauseTiming();
    for (int i = 0; i < 6; ++i)
      world.floor(-25, -19, -25, -9, mud ? PaintedWorld::Mud : PaintedWorld::Road)
          .map({-22.05, -20.05, 20});
    mud = !mud;
    state.ResumeTiming();
    update = planner.update();
    result = planner.replan(kStart);
    addStages(update.times, sums);
    addStages(result.times, sums);
  }
  reportStages(state, sums);
  reportPlan(state, result);
  state.counters["tiles"] = double(update.tilesChanged);
}
BENCHMARK(replanAfterOnePercentChanged)->Unit(benchmark::kMillisecond);

}  // namespace
