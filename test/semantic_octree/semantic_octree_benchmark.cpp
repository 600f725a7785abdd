// The parts of an insertion, on a LiDAR scan of 64 x 1024 beams in a street.
#include <RayMarking.h>
#include <Scan.h>
#include <ScanMerger.h>
#include <benchmark/benchmark.h>
#include <semantic_octree/TreeFile.h>

#include <sstream>

#include "FilterStreams.h"
#include "RandomScans.h"

using namespace semantic_octree;

namespace {

constexpr int K = 24;

const PosedCloud& street() {
  static const PosedCloud scan = [] {
    std::mt19937 random(1);
    return streetScan(random, {0, 0, 0}, 64, 1024);
  }();
  return scan;
}

/** Argument of the benchmarks below: voxel size in centimeters. */
double resolutionOf(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) / 100;
}

InsertionOptions insertion() {
  InsertionOptions options;
  options.maxRange = 25;
  return options;
}

SemanticOcTree streetMap(double resolution, int scans, bool withAbstraction = false) {
  SemanticOcTree map(resolution, numberedClasses(K));
  AbstractionOptions options;
  for (int i = 1; i <= 4; ++i)
    options.weights.terms.push_back(tree_abstraction::relevant(std::to_string(i), 1, {i}));
  options.weights.alpha = 0.02;
  if (withAbstraction) map.setAbstraction(options);
  for (int i = 0; i < scans; ++i) map.insert(street().cloud, street().T_map_sensor, insertion());
  return map;
}

void filterHit(benchmark::State& state) {
  const ClassFilter<float> filter(K, {});
  std::mt19937 random(1);
  const auto labels = randomStream(random, 1024, K, static_cast<int>(state.range(0)));
  Belief belief = filter.uniform(0);
  std::size_t i = 0;
  for (auto _ : state) {
    filter.hit(belief, std::max<ClassId>(1, labels[i++ % labels.size()].id));
    benchmark::DoNotOptimize(belief);
  }
}
BENCHMARK(filterHit)->ArgName("classes")->Arg(1)->Arg(3)->Arg(10);

void filterMissOfARecord(benchmark::State& state) {
  const ClassFilter<float> filter(K, {});
  Belief hit = filter.uniform(0);
  for (const ClassId id : {3, 3, 3, 9, 4}) filter.hit(hit, id);
  for (auto _ : state) {
    Belief belief = hit;
    filter.miss(belief);
    benchmark::DoNotOptimize(belief);
  }
}
BENCHMARK(filterMissOfARecord);

void occupancyOfARecord(benchmark::State& state) {
  const ClassFilter<float> filter(K, {});
  Belief belief = filter.uniform(0);
  for (const ClassId id : {3, 3, 3, 9, 4}) filter.hit(belief, id);
  for (auto _ : state) {
    benchmark::DoNotOptimize(belief);
    benchmark::DoNotOptimize(belief.occupancyLogOdds(K));
  }
}
BENCHMARK(occupancyOfARecord);

void softLabelHit(benchmark::State& state) {
  const ClassFilter<float> filter(K, {});
  std::vector<float> q(K, 0.5f / (K - 1));
  q[6] = 0.5f;
  Belief belief = filter.uniform(0);
  for (auto _ : state) {
    filter.hit(belief, q.data());
    benchmark::DoNotOptimize(belief);
  }
}
BENCHMARK(softLabelHit);

/** One ray of 100 m; items are voxels. */
void markRayOfOneDirection(benchmark::State& state) {
  TileGrid grid;
  grid.cover({-1000, -1000, -1000}, {1000, 1000, 1000});
  const Eigen::Array3d begin = Eigen::Array3d(0.3, 0.4, 0.5) - grid.origin();
  const Eigen::Array3d end = begin + Eigen::Array3d(600, -330, 70);
  for (auto _ : state) markRay(grid, begin, end);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * 1000);
}
BENCHMARK(markRayOfOneDirection);

/** Transforming, marking, summarizing and voting: all of an insertion but the tree. */
void scanIntoVoxels(benchmark::State& state) {
  Scan scan;
  for (auto _ : state) {
    scan.set(street().cloud, street().T_map_sensor, resolutionOf(state), K, insertion());
    scan.clear();
  }
}
BENCHMARK(scanIntoVoxels)->ArgName("cm")->Arg(20)->Arg(10)->Unit(benchmark::kMillisecond);

/** The tree's part: a scan merged into a map that has it already. */
void mergeIntoTree(benchmark::State& state) {
  const double resolution = resolutionOf(state);
  const ClassFilter<float> filter(K, {});
  NodeStore store(0);
  Scan scan;
  scan.set(street().cloud, street().T_map_sensor, resolution, K, insertion());
  const MergeTarget target{store, filter, nullptr, true};
  mergeScan(target, scan, store.root(), true, 1);
  for (auto _ : state) mergeScan(target, scan, store.root(), false, 1);
}
BENCHMARK(mergeIntoTree)->ArgName("cm")->Arg(20)->Arg(10)->Unit(benchmark::kMillisecond);

/** The first scan of a map: all nodes are new. */
void insertIntoEmptyMap(benchmark::State& state) {
  SemanticOcTree map = streetMap(resolutionOf(state), 0, state.range(1));
  for (auto _ : state) {
    map.insert(street().cloud, street().T_map_sensor, insertion());
    state.PauseTiming();
    map.clear();
    state.ResumeTiming();
  }
}
BENCHMARK(insertIntoEmptyMap)
    ->ArgNames({"cm", "G"})
    ->ArgsProduct({{20, 10}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void insertAgain(benchmark::State& state) {
  SemanticOcTree map = streetMap(resolutionOf(state), 1, state.range(1));
  for (auto _ : state) map.insert(street().cloud, street().T_map_sensor, insertion());
}
BENCHMARK(insertAgain)
    ->ArgNames({"cm", "G"})
    ->ArgsProduct({{20, 10}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void write(benchmark::State& state) {
  const SemanticOcTree map = streetMap(0.1, 2);
  std::int64_t bytes = 0;
  for (auto _ : state) {
    std::ostringstream out;
    writeTree(out, map);
    bytes += out.tellp();
  }
  state.SetBytesProcessed(bytes);
}
BENCHMARK(write)->Unit(benchmark::kMillisecond);

void read(benchmark::State& state) {
  std::stringstream stream;
  writeTree(stream, streetMap(0.1, 2));
  for (auto _ : state) {
    stream.seekg(0);
    benchmark::DoNotOptimize(readTree(stream));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * stream.tellp());
}
BENCHMARK(read)->Unit(benchmark::kMillisecond);

}  // namespace
