// Upkeep, search and re-weighting of the abstraction, with the plain full pass beside them.
#include <benchmark/benchmark.h>
#include <semantic_abstraction/Abstraction.h>

#include "OctreeAsTree.h"
#include "SmallScans.h"

namespace {

using namespace semantic_octree;

constexpr int K = 24;

AbstractionOptions withTerms(int terms) {
  AbstractionOptions o;
  for (int t = 1; t <= terms; ++t)
    o.weights = {{tree_abstraction::relevant("class " + std::to_string(t), 1.0 / t, {t})}, 0.002};
  return o;
}

InsertionOptions shortRange() {
  InsertionOptions o;
  o.maxRange = 3;
  return o;
}

/** A map of about a million leaves, of scans of 60 thousand points with a long range; and one more
 * scan with a short range, which touches a small part of it. */
struct Place {
  static constexpr std::size_t kScans = 10;
  std::vector<PosedCloud> scans = scansOfSmallPlace(kScans + 1, 60000, K, 1);
  SemanticOcTree map{0.05, numberedClasses(K)};

  explicit Place(int terms) {
    if (terms > 0) setAbstraction(map, withTerms(terms));
    for (std::size_t i = 0; i < kScans; ++i) map.insert(scans[i].cloud, scans[i].T_map_sensor);
  }
  void insertOneMore(SemanticOcTree& copy) const {
    copy.insert(scans[kScans].cloud, scans[kScans].T_map_sensor, shortRange());
  }
};

/** One more scan into a map. Argument: number of terms; 0: no abstraction is kept. */
void insertScan(benchmark::State& state) {
  const int terms = static_cast<int>(state.range(0));
  const Place place(terms);
  for (auto _ : state) {
    state.PauseTiming();
    SemanticOcTree map(place.map);
    state.ResumeTiming();
    place.insertOneMore(map);
    state.PauseTiming();
    map = SemanticOcTree(0.05, numberedClasses(1));
    state.ResumeTiming();
  }
  state.counters["leaves"] = static_cast<double>(place.map.getNumLeafNodes());
}
BENCHMARK(insertScan)->Arg(0)->Arg(4)->Arg(24)->Unit(benchmark::kMillisecond);

/** Without upkeep, all of the map is laid out and computed anew. */
void plainFullPass(benchmark::State& state) {
  const Place place(4);
  const auto weights = withTerms(4).weights;
  for (auto _ : state) {
    auto found = reference::findOptimalTree(OctreeAsTree(place.map, 9, 9).forest, weights);
    benchmark::DoNotOptimize(found.objective);
  }
  state.counters["leaves"] = static_cast<double>(place.map.getNumLeafNodes());
}
BENCHMARK(plainFullPass)->Unit(benchmark::kMillisecond);

/** All G-values from scratch, with the octree's own arithmetic. */
void batchPass(benchmark::State& state) {
  Place place(4);
  for (auto _ : state) setAbstraction(place.map, withTerms(4));
}
BENCHMARK(batchPass)->Unit(benchmark::kMillisecond);

void search(benchmark::State& state) {
  Place place(4);
  Abstraction abstraction(place.map);
  std::size_t leaves = 0;
  for (auto _ : state) leaves = abstraction.leaves().size();
  state.counters["leaves"] = static_cast<double>(leaves);
  state.counters["time_per_leaf"] = benchmark::Counter(
      static_cast<double>(leaves),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(search)->Unit(benchmark::kMillisecond);

/** New weights of four terms. */
void reweigh(benchmark::State& state) {
  Place place(4);
  Abstraction abstraction(place.map);
  const std::size_t inner = place.map.size() - place.map.getNumLeafNodes();
  double alpha = 0.001;
  for (auto _ : state) abstraction.setWeights({1, -0.5, 0.3, 0.2}, alpha += 1e-6);
  state.counters["inner"] = static_cast<double>(inner);
  state.counters["time_per_inner"] =
      benchmark::Counter(static_cast<double>(inner), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}
BENCHMARK(reweigh)->Unit(benchmark::kMillisecond);

/** Changes of the compressed tree after one more scan. */
void followChange(benchmark::State& state) {
  const Place place(4);
  std::size_t changed = 0;
  for (auto _ : state) {
    state.PauseTiming();
    SemanticOcTree map(place.map);
    LeafFollower follower(map);
    follower.skipLeaves();
    place.insertOneMore(map);
    state.ResumeTiming();
    const TreeChange change = follower.leaves();
    changed = change.added.size() + change.removed.size();
  }
  state.counters["changed"] = static_cast<double>(changed);
}
BENCHMARK(followChange)->Unit(benchmark::kMillisecond);

}  // namespace
