// A drive through a street: into a plain map, into a folder's tiles
// that are all in memory, and under a budget; then tiles come in.
#include <benchmark/benchmark.h>
#include <map_folders/MapFolder.h>

#include <filesystem>

#include "StreetDrive.h"
#include "TemporaryFolder.h"

using namespace street_drive;

namespace {

void plain(benchmark::State& state) {
  scans();
  for (auto _ : state) {
    SemanticOcTree map = emptyMap(state.range(0));
    insertAll(map);
    state.counters["MB"] = static_cast<double>(map.memoryUsage()) / 1e6;
  }
}

void inFolder(benchmark::State& state, double memory) {
  scans();
  for (auto _ : state) {
    const TemporaryFolder folder;
    SemanticOcTree map = emptyMap(state.range(0));
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
    SemanticOcTree map = emptyMap(state.range(0));
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
