// A cycle of a drive through the village, from an empty map of 0.2 m: insert a labeled depth image
// of 320 x 240 with the G-values, update ground and roadmap, repair the path, look for obstacles,
// react. One core; milliseconds of the processor.
#include <benchmark/benchmark.h>
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Scene.h>

#include <algorithm>

#include "simulated_drive/DriveLoop.h"

using namespace simulated_drive;

namespace {

const std::string kConfig = std::string(MSO_SOURCE_DIR) + "/config/";

DriveConfig config320() {
  DriveConfig config = loadDriveConfig(kConfig + "drives/synthetic.ini");
  config.sensors.camera.width = 320;
  config.sensors.camera.height = 240;
  return config;
}

using Times = std::vector<double>;

/** Obstacles and reaction come more often than observations: each cycle gets one of each. */
Times wholeCycles(const DriveRecord& record, std::size_t stepsPerCycle) {
  Times cycles = record.times.at("insert+update+replan");
  const Times &obstacles = record.times.at("obstacles"), &react = record.times.at("react");
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const std::size_t step = std::min(i * stepsPerCycle, react.size() - 1);
    cycles[i] += obstacles[step] + react[step];
  }
  return cycles;
}

void report(benchmark::State& state, const std::string& stage, Times times) {
  std::sort(times.begin(), times.end());
  const auto at = [&times](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  state.counters[stage + "_p50_ms"] = at(0.5);
  state.counters[stage + "_p95_ms"] = at(0.95);
}

void DriveCycle(benchmark::State& state) {
  const DriveConfig config = config320();
  const auto order = semantic_planning::loadClassOrder(kConfig + "orders/synthetic.yaml",
                                                       synthetic_world::classTable());
  const mrpt::math::TPose2D start{-14, -19, 10 * M_PI / 180}, goal{25, -12, M_PI / 2};
  for (auto _ : state) {
    auto scene = synthetic_world::makeScene("village", 1);
    DriveLoop loop(config, scene.world, order, start, goal, {});
    const DriveRecord& record = loop.run();
    const Times cycles =
        wholeCycles(record, std::lround(config.sensors.period / config.controlPeriod));
    double sum = 0;
    for (const double milliseconds : cycles) sum += milliseconds;
    state.SetIterationTime(sum / 1e3 / static_cast<double>(cycles.size()));
    for (const auto& [stage, times] : record.times)
      if (stage != "simulate") report(state, stage, times);
    report(state, "cycle", cycles);
    state.counters["cycles"] = static_cast<double>(cycles.size());
    state.counters["arrived"] = record.arrived() ? 1 : 0;
  }
}
BENCHMARK(DriveCycle)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
