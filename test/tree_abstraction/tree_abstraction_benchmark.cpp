#include <benchmark/benchmark.h>
#include <tree_abstraction/AlphaPath.h>

#include <cmath>

#include "RandomTrees.h"

using namespace tree_abstraction;

namespace {

/** The inner nodes of a full octree, with gains that make about half of them pay at alpha 0.1. */
struct InnerNodes {
  std::vector<std::int32_t> parents;
  std::vector<double> gains, prices;

  explicit InnerNodes(std::int32_t size) : gains(1, 0.1), prices(1, std::log(8.0)) {
    random_trees::Engine random(1);
    parents.push_back(-1);
    for (std::int32_t i = 1; i < size; ++i) {
      parents.push_back((i - 1) / 8);
      prices.push_back(prices[static_cast<std::size_t>(parents.back())] / 8);
      gains.push_back(prices.back() * 0.2 * random_trees::uniform(random));
    }
  }
};

void countInnerNodes(benchmark::State& state) {
  state.counters["time/inner"] = benchmark::Counter(
      static_cast<double>(state.range(0)),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void wholeAlphaPath(benchmark::State& state) {
  const InnerNodes nodes(static_cast<std::int32_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(collapseAlphas(nodes.parents, nodes.gains, nodes.prices));
  }
  countInnerNodes(state);
}
BENCHMARK(wholeAlphaPath)->Arg(1 << 15)->Arg(1 << 20)->Unit(benchmark::kMillisecond);

void sortedAlphaPath(benchmark::State& state) {
  const InnerNodes nodes(static_cast<std::int32_t>(state.range(0)));
  const auto tau = collapseAlphas(nodes.parents, nodes.gains, nodes.prices);
  for (auto _ : state) benchmark::DoNotOptimize(AlphaPath(tau));
  countInnerNodes(state);
}
BENCHMARK(sortedAlphaPath)->Arg(1 << 15)->Arg(1 << 20)->Unit(benchmark::kMillisecond);

}  // namespace
