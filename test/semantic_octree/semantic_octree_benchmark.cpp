// The parts of an insertion, on a LiDAR scan of 64 x 1024 beams in a street.
#include <benchmark/benchmark.h>
#include <map_operations/SmoothedView.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_octree/store/Scan.h>

#include <sstream>

#include "FilterStreams.h"
#include "RandomScans.h"
#include "ScanMerger.h"

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
    options.weights = {{tree_abstraction::relevant(std::to_string(i), 1, {i})}, 0.02};
  if (withAbstraction) setAbstraction(map, options);
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

/** A fan of rays of 100 voxels; items are voxels. */
void markFanOfRays(benchmark::State& state) {
  ScanGrid grid;
  grid.cover({-100, -100, -100}, {100, 100, 100}, 1 << 24);
  const Eigen::Array3d begin = Eigen::Array3d(0.3, 0.4, 0.5) - grid.origin();
  std::vector<Eigen::Array3d> ends;
  std::int64_t voxels = 0;
  for (double angle = 0; angle < 6; angle += 0.01) {
    ends.push_back(begin + 90 * Eigen::Array3d(std::cos(angle), std::sin(angle), 0.1));
    voxels += (ends.back().floor() - begin.floor()).abs().sum();
  }
  for (auto _ : state) markRays(grid, begin, ends.data(), ends.size());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * voxels);
}
BENCHMARK(markFanOfRays);

/** Transforming, marking, summarizing and voting: all of an insertion but the tree. */
void scanIntoVoxels(benchmark::State& state) {
  const ClassFilter<float> filter(K, {});
  Scan scan;
  for (auto _ : state) {
    scan.set(street().cloud, street().T_map_sensor, resolutionOf(state), filter, insertion());
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
  scan.set(street().cloud, street().T_map_sensor, resolution, filter, insertion());
  const MergeTarget target{store, filter, nullptr, nullptr, nullptr, true};
  mergeScan(target, scan, 1);
  for (auto _ : state) mergeScan(target, scan, 1);
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

/** A scan into a map of that many other places. */
void insertIntoLargeMap(benchmark::State& state) {
  SemanticOcTree map(0.1, numberedClasses(K));
  PosedCloud scan = street();
  for (int i = 0; i < state.range(0); ++i) {
    scan.T_map_sensor.translation() =
        Eigen::Vector3d(-1200.0 + 60.0 * (i % 40), 60.0 * (i / 40), 0);
    map.insert(scan.cloud, scan.T_map_sensor, insertion());
  }
  int step = 0;
  for (auto _ : state) {  // new space each time, as on a drive
    scan.T_map_sensor.translation() = Eigen::Vector3d(-1200 + 0.5 * step++, 2, 0);
    map.insert(scan.cloud, scan.T_map_sensor, insertion());
  }
  state.counters["leaves"] = static_cast<double>(map.getNumLeafNodes());
}
BENCHMARK(insertIntoLargeMap)
    ->ArgName("places")
    ->Arg(1)
    ->Arg(10)
    ->Arg(80)
    ->Iterations(40)
    ->Unit(benchmark::kMillisecond);

/** What the time grows with: 20 scans of a drive. */
void insertDrive(benchmark::State& state, double resolution, double maxRange, int classes,
                 int threads) {
  PosedCloud scan = street();
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    scan.cloud.classes[i] = static_cast<ClassId>(1 + i / 7 % classes);
  InsertionOptions options;
  options.maxRange = maxRange;
  options.threads = threads;
  for (auto _ : state) {
    SemanticOcTree map(resolution, numberedClasses(classes));
    for (int i = 0; i < 20; ++i) {
      scan.T_map_sensor.translation().x() = 0.5 * i;
      map.insert(scan.cloud, scan.T_map_sensor, options);
    }
  }
}
BENCHMARK_CAPTURE(insertDrive, range10m, 0.2, 10, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, range25m, 0.2, 25, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, range40m, 0.2, 40, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, voxels40cm, 0.4, 25, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, voxels10cm, 0.1, 25, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, voxels5cm, 0.05, 25, 24, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, classes1, 0.2, 25, 1, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, classes254, 0.2, 25, 254, 1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertDrive, threads2, 0.2, 25, 24, 2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(insertDrive, threads2At10cm, 0.1, 25, 24, 2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/** The class of each voxel with a return: of itself, with its neighbors, or, as if none had been
 * seen in it, of those alone. Items are voxels. */
enum class Asked { Voxel, WithNeighbors, Gap };
void queryClass(benchmark::State& state, Asked asked) {
  const SemanticOcTree map = streetMap(resolutionOf(state), 2);
  const SmoothedView view(map);
  std::vector<octomap::OcTreeKey> keys;
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!leaf->hasClassRecord()) continue;
    keys.push_back(leaf.getKey());
    if (asked == Asked::Gap) keys.back()[2] += 2;
  }
  for (auto _ : state)
    for (const auto& key : keys)
      benchmark::DoNotOptimize(asked == Asked::Voxel ? map.query(key) : view.query(key));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * keys.size()));
}
BENCHMARK_CAPTURE(queryClass, voxel, Asked::Voxel)->ArgName("cm")->Arg(20)->Arg(10);
BENCHMARK_CAPTURE(queryClass, withNeighbors, Asked::WithNeighbors)->ArgName("cm")->Arg(20)->Arg(10);
BENCHMARK_CAPTURE(queryClass, gap, Asked::Gap)->ArgName("cm")->Arg(20)->Arg(10);

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
