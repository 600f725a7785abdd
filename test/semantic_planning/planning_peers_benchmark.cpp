// OMPL's planners and ours on the same tasks in a town of 100 m, ground known: what a path costs
// after equal time, and when the first one is there. The peers minimize the sum of 10^rank *
// length; ours is judged by that, too, though it minimizes something else. Times are of the
// processor.
#include <Groups.h>
#include <Instances.h>
#include <Peers.h>
#include <RoadmapTrials.h>
#include <benchmark/benchmark.h>

#include <cmath>

#include "Town.h"

using namespace planning_study;
using namespace semantic_planning;

namespace {

constexpr int kTasks = 20;
constexpr double kMinDistance = 60;  // m

PlannerOptions optionsOf(GraphKind kind, std::size_t vertices) {
  PlannerOptions options;
  options.roadmap.kind = kind;
  options.roadmap.vertices = vertices;
  return options;
}

RoadmapTrials& compressed() {
  static RoadmapTrials trials(town::map(), town::order(), optionsOf(GraphKind::Compressed, 1000),
                              false);
  return trials;
}

const std::vector<Instance>& tasks() {
  static const std::vector<Instance> tasks = [] {
    const SemanticPlanner& planner = compressed().planner();
    const CollisionChecker checker(planner.ground(), planner.options().vehicle, town::order(), {});
    return drawInstances(checker, kTasks, kMinDistance, 1);
  }();
  return tasks;
}

/** What the others' costs are divided by. */
const std::vector<Trial>& yardstick() {
  static const std::vector<Trial> yardstick = [] {
    std::vector<Trial> trials;
    for (const Instance& task : tasks()) trials.push_back(compressed().plan(task));
    return trials;
  }();
  return yardstick;
}

/** Ratios of costs count by their geometric mean, over the tasks that both solve. */
class Report {
 public:
  void add(const Trial& trial, const Trial& yard) {
    ++m_trials;
    if (!trial.found) return;
    ++m_found;
    m_first += trial.timeToFirstPath();
    if (!yard.found) return;
    ++m_compared;
    m_logRatio += std::log(weightedMeters(trial) / weightedMeters(yard));
    m_betterOrEqual += compareTrials(trial, yard, &Trial::way) <= 0;
  }
  void writeTo(benchmark::State& state) const {
    state.counters["solved"] = m_found / m_trials;
    state.counters["first_path_ms"] = m_first / m_found;
    state.counters["cost"] = std::exp(m_logRatio / m_compared);
    state.counters["not_worse"] = m_betterOrEqual / m_compared;
  }

 private:
  double m_trials = 0, m_found = 0, m_first = 0, m_compared = 0, m_logRatio = 0,
         m_betterOrEqual = 0;
};

template <class Solve>
void run(benchmark::State& state, Solve solve) {
  const auto& yard = yardstick();
  Report report;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t task = i++ % kTasks;
    const Trial trial = solve(tasks()[task]);
    state.SetIterationTime(1e-3 * trial.totalTime());
    report.add(trial, yard[task]);
  }
  report.writeTo(state);
}

void ours(benchmark::State& state, GraphKind kind, bool kept) {
  const auto vertices = static_cast<std::size_t>(state.range(0));
  RoadmapTrials trials(town::map(), town::order(), optionsOf(kind, vertices), kept);
  run(state, [&](const Instance& task) { return trials.plan(task); });
}

void peer(benchmark::State& state, const std::string& name) {
  const SemanticPlanner& planner = compressed().planner();
  const double seconds = 1e-3 * static_cast<double>(state.range(0));
  run(state, [&](const Instance& task) { return runPeer(name, planner, task, seconds); });
}

template <class Function, class... Arguments>
auto* registered(const std::string& name, Function f, Arguments... arguments) {
  return benchmark::RegisterBenchmark(name.c_str(), f, arguments...)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(kTasks);
}

const bool kRegistered = [] {
  for (const GraphKind kind : {GraphKind::Compressed, GraphKind::HaltonDrivable})
    for (const bool kept : {false, true})
      registered(std::string(nameOf(kind)) + " " + memoryName(kept), ours, kind, kept)
          ->ArgName("vertices")
          ->Arg(300)
          ->Arg(1000)
          ->Arg(3000);
  for (const std::string& name : peerNames())
    registered(name, peer, name)->ArgName("ms")->Arg(30)->Arg(100)->Arg(300)->Arg(1000);
  return true;
}();

}  // namespace
