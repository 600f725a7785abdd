// What forgetting costs: a drive through a street, 64 x 1024 beams, ten scans a second, and the
// time that passes between two of them.
#include <benchmark/benchmark.h>
#include <semantic_octree/Abstraction.h>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr int kScans = 200;
constexpr double kPeriod = 0.1;  // s

const std::vector<PosedCloud>& drive() {
  static const std::vector<PosedCloud> scans = [] {
    std::mt19937 random(1);
    std::vector<PosedCloud> made;
    for (int i = 0; i < kScans; ++i) {
      made.push_back(streetScan(random, {double(i), 0, 0}, 64, 1024));
      for (auto& id : made.back().cloud.classes)
        if (random() % 100 == 0) id = 3;  // a person here and there
    }
    return made;
  }();
  return scans;
}

enum Forgets { kNothing, kPeople, kPeopleAndFreeSpace };

SemanticOcTree emptyMap(int forgets, bool withAbstraction) {
  semantic_types::ClassTable classes = numberedClasses(24);
  if (forgets != kNothing) classes.setHalfLife(3, 2);
  if (forgets == kPeopleAndFreeSpace) classes.setHalfLife(semantic_types::kNoClass, 60);
  SemanticOcTree map(0.2, classes);
  if (!withAbstraction) return map;
  AbstractionOptions options;
  for (int i = 1; i <= 4; ++i)
    options.weights.terms.push_back(tree_abstraction::relevant(std::to_string(i), 1, {i}));
  options.weights.alpha = 0.02;
  map.setAbstraction(options);
  return map;
}

void mapping(benchmark::State& state) {
  drive();
  InsertionOptions options;
  options.maxRange = 25;
  for (auto _ : state) {
    SemanticOcTree map = emptyMap(static_cast<int>(state.range(0)), state.range(1));
    for (const PosedCloud& scan : drive())
      map.insert(scan.cloud, scan.T_map_sensor, options, kPeriod);
    state.counters["leaves"] = static_cast<double>(map.getNumLeafNodes());
  }
}

/** One of a class's eight steps, in the map of the whole drive. */
void step(benchmark::State& state) {
  InsertionOptions options;
  options.maxRange = 25;
  SemanticOcTree map = emptyMap(static_cast<int>(state.range(0)), state.range(1));
  for (const PosedCloud& scan : drive()) map.insert(scan.cloud, scan.T_map_sensor, options);
  state.counters["leaves"] = static_cast<double>(map.getNumLeafNodes());
  for (auto _ : state) {
    state.PauseTiming();
    SemanticOcTree copy = map;
    state.ResumeTiming();
    copy.age(state.range(0) == kPeople ? 0.25 : 7.5);
  }
}

BENCHMARK(mapping)
    ->ArgNames({"forgets", "g"})
    ->ArgsProduct({{kNothing, kPeople, kPeopleAndFreeSpace}, {0, 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(step)
    ->ArgNames({"forgets", "g"})
    ->ArgsProduct({{kPeople, kPeopleAndFreeSpace}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
