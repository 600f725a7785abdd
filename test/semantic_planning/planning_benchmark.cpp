// Planning across a map of 100 m, ground known, in stages; reading the ground; replanning after 1 %
// of the map's columns changed. One core.
#include <benchmark/benchmark.h>
#include <semantic_planning/OrderAbstraction.h>
#include <semantic_planning/SemanticPlanner.h>

#include "PaintedWorld.h"

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

constexpr double kHalf = 50;  // m

const colored_graph::ClassOrder& order() {
  static const colored_graph::ClassOrder order(5, {{1}, {2}, {4}, {0}});
  return order;
}

/** Blocks of houses in grass, with streets of 6 m every 25 m. */
PaintedWorld town() {
  PaintedWorld world;
  world.floor(-kHalf, kHalf, -kHalf, kHalf, PaintedWorld::Grass);
  for (double at = -50; at < 50; at += 25) {
    world.floor(at, at + 6, -kHalf, kHalf, PaintedWorld::Road);
    world.floor(-kHalf, kHalf, at, at + 6, PaintedWorld::Road);
  }
  for (double x = -50; x < 50; x += 25)
    for (double y = -50; y < 50; y += 25) {
      world.box(x + 10, x + 15, y + 10, y + 19, 0, 2, PaintedWorld::Wall);
      world.floor(x + 18, x + 21, y + 10, y + 15, PaintedWorld::Mud);
    }
  return world;
}

semantic_octree::SemanticOcTree& townMap() {
  static PaintedWorld world = town();
  static semantic_octree::SemanticOcTree& map = world.map({0.05, 0.05, 60});
  if (!map.hasAbstraction()) map.setAbstraction(abstractionFor(order()));
  return map;
}

PlannerOptions optionsOf(GraphKind kind) {
  PlannerOptions options;  // turning radius 1 m, 1000 vertices
  options.roadmap.kind = kind;
  return options;
}

const TPose2D kStart{-47, -47, M_PI / 2}, kGoal{45, 28, 0};

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
  for (auto _ : state)
    benchmark::DoNotOptimize(Ground(townMap(), options.vehicle, options.ground, order()));
}
BENCHMARK(readGround)->Unit(benchmark::kMillisecond);

void plan(benchmark::State& state) {
  SemanticPlanner planner(townMap(), order(), optionsOf(static_cast<GraphKind>(state.range(0))));
  std::map<std::string, double> sums;
  PlanResult result;
  for (auto _ : state) {
    result = planner.plan(kStart, kGoal);
    addStages(result.times, sums);
  }
  if (!result.found()) state.SkipWithError(result.reason.c_str());
  reportStages(state, sums);
  reportPlan(state, result);
}
BENCHMARK(plan)
    ->ArgName("kind")
    ->DenseRange(int(GraphKind::Compressed), int(GraphKind::Full))
    ->Unit(benchmark::kMillisecond);

/** A square of 10 m on the way turns to mud, and back to road. */
void replanAfterOnePercentChanged(benchmark::State& state) {
  PaintedWorld world = town();
  semantic_octree::SemanticOcTree& map = world.map({0.05, 0.05, 60});
  map.setAbstraction(abstractionFor(order()));
  SemanticPlanner planner(map, order(), optionsOf(GraphKind::Compressed));
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
  state.counters["edges_changed"] = double(update.edgesChanged);
}
BENCHMARK(replanAfterOnePercentChanged)->Unit(benchmark::kMillisecond);

}  // namespace
