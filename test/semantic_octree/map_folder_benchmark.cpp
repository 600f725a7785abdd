// A drive through a street, 64 x 1024 beams every meter: into a plain map, into a folder's tiles
// that are all in memory, and under a budget; then tiles come in.
#include <benchmark/benchmark.h>
#include <semantic_octree/MapFolder.h>

#include <filesystem>

#include "RandomScans.h"
#include "TemporaryFolder.h"

using namespace semantic_octree;

namespace {

constexpr int kScans = 200;

const std::vector<PosedCloud>& drive() {
  static const std::vector<PosedCloud> scans = [] {
    std::mt19937 random(1);
    std::vector<PosedCloud> made;
    for (int i = 0; i < kScans; ++i)
      made.push_back(streetScan(random, {double(i), 0, 0}, 64, 1024));
    return made;
  }();
  return scans;
}

SemanticOcTree emptyMap() { return {0.2, numberedClasses(24)}; }

void setAbstraction(SemanticOcTree& map) {
  AbstractionOptions options;
  for (int i = 1; i <= 4; ++i)
    options.weights.terms.push_back(tree_abstraction::relevant(std::to_string(i), 1, {i}));
  options.weights.alpha = 0.02;
  map.setAbstraction(options);
}

void insertAll(SemanticOcTree& map) {
  InsertionOptions options;
  options.maxRange = 25;
  for (const PosedCloud& scan : drive()) map.insert(scan.cloud, scan.T_map_sensor, options);
}

void plain(benchmark::State& state) {
  drive();
  for (auto _ : state) {
    SemanticOcTree map = emptyMap();
    if (state.range(0)) setAbstraction(map);
    insertAll(map);
    state.counters["MB"] = static_cast<double>(map.memoryUsage()) / 1e6;
  }
}

void inFolder(benchmark::State& state, double memory) {
  drive();
  for (auto _ : state) {
    const TemporaryFolder folder;
    SemanticOcTree map = emptyMap();
    if (state.range(0)) setAbstraction(map);
    MapFolderOptions options;
    options.memory = memory;
    MapFolder tiles(map, folder.path(), MapFolder::Access::Write, options);
    insertAll(map);
    state.counters["sent"] = static_cast<double>(tiles.contents().sentOut);
  }
}

void tilesInMemory(benchmark::State& state) { inFolder(state, 500); }
void underABudget(benchmark::State& state) { inFolder(state, 2); }

void comingIn(benchmark::State& state) {
  const TemporaryFolder folder;
  double bytes = 0;
  {
    SemanticOcTree map = emptyMap();
    MapFolder tiles(map, folder.path(), MapFolder::Access::Write);
    insertAll(map);
    tiles.save();
    bytes = static_cast<double>(tiles.contents().bytesOnDisk);
  }
  for (auto _ : state) {
    SemanticOcTree map = emptyMap();
    if (state.range(0)) setAbstraction(map);
    MapFolder tiles(map, folder.path(), MapFolder::Access::Read);
    tiles.bringAll();
  }
  state.counters["MB/s"] = benchmark::Counter(
      bytes * 1e-6 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(plain)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(tilesInMemory)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(underABudget)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(comingIn)->ArgName("g")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
