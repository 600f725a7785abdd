// What forgetting costs: a drive through a street, 64 x 1024 beams, ten scans a second, and the
// time that passes between two of them.
#include <benchmark/benchmark.h>
#include <semantic_abstraction/Abstraction.h>

#include "StreetDrive.h"

using namespace street_drive;

namespace {

constexpr double kPeriod = 0.1;  // s

/** The street's drive, with a person here and there. */
const std::vector<PosedCloud>& drive() {
  static const std::vector<PosedCloud> scans = [] {
    std::mt19937 random(2);
    std::vector<PosedCloud> made = street_drive::scans();
    for (PosedCloud& scan : made)
      for (auto& id : scan.cloud.classes)
        if (random() % 100 == 0) id = 3;
    return made;
  }();
  return scans;
}

enum Forgets { kNothing, kPeople, kPeopleAndFreeSpace };

SemanticOcTree emptyMap(int forgets, bool withAbstraction) {
  semantic_types::ClassTable classes = numberedClasses(24);
  if (forgets != kNothing) classes.setHalfLife(3, 2);
  if (forgets == kPeopleAndFreeSpace) classes.setHalfLife(semantic_types::kNoClass, 60);
  return street_drive::emptyMap(withAbstraction, classes);
}

void mapping(benchmark::State& state) {
  drive();
  for (auto _ : state) {
    SemanticOcTree map = emptyMap(static_cast<int>(state.range(0)), state.range(1));
    for (const PosedCloud& scan : drive())
      map.insert(scan.cloud, scan.T_map_sensor, insertion(), kPeriod);
    state.counters["leaves"] = static_cast<double>(map.getNumLeafNodes());
  }
}

/** One of a class's eight steps, in the map of the whole drive. */
void step(benchmark::State& state) {
  SemanticOcTree map = emptyMap(static_cast<int>(state.range(0)), state.range(1));
  for (const PosedCloud& scan : drive()) map.insert(scan.cloud, scan.T_map_sensor, insertion());
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
