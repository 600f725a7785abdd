#include <benchmark/benchmark.h>
#include <reference/GTreeSearch.h>
#include <tree_abstraction/AlphaPath.h>

#include <cmath>

#include "RandomTrees.h"

using namespace tree_abstraction;
using namespace reference;

namespace {

constexpr std::size_t kFamilies = 64;

/** Four yes-or-no terms, as an outdoor map has. */
AbstractionWeights fourTerms() {
  return {{relevant("a", 1, {1}), relevant("b", 1, {2}), irrelevant("c", 0.3, {3}),
           irrelevant("d", 0.3, {4})},
          0.01};
}

/** Rows of eight children each. */
std::vector<double> makeRows(std::size_t width) {
  random_trees::Engine random(1);
  std::vector<double> rows(kFamilies * 8 * width);
  for (double& p : rows) p = random_trees::uniform(random);
  return rows;
}

/** One parent with 4 terms: mixture, entropies anew, and JS from those kept of the children. */
void fastDivergenceOfFourTerms(benchmark::State& state) {
  constexpr std::size_t kTerms = 4;
  const auto rows = makeRows(kTerms);
  const std::vector<double> pi(8, 0.125);
  std::vector<double> entropies;
  for (const double p : rows) entropies.push_back(binaryEntropy(p));
  std::size_t i = 0;
  double mixed[kTerms], divergence[kTerms];
  for (auto _ : state) {
    const std::size_t first = (i++ % kFamilies) * 8 * kTerms;
    mixRows(pi.data(), rows.data() + first, 8, kTerms, mixed);
    for (std::size_t t = 0; t < kTerms; ++t) {
      divergence[t] =
          entropyDrop(binaryEntropy(mixed[t]), pi.data(), entropies.data() + first + t, 8, kTerms);
    }
    benchmark::DoNotOptimize(divergence);
  }
}
BENCHMARK(fastDivergenceOfFourTerms);

void stableDivergenceOfFourTerms(benchmark::State& state) {
  constexpr std::size_t kTerms = 4;
  const auto rows = makeRows(kTerms);
  const std::vector<double> pi(8, 0.125);
  std::size_t i = 0;
  double divergence[kTerms];
  for (auto _ : state) {
    const std::size_t first = (i++ % kFamilies) * 8 * kTerms;
    for (std::size_t t = 0; t < kTerms; ++t) {
      divergence[t] = binaryJensenShannon(pi.data(), rows.data() + first + t, 8, kTerms);
    }
    benchmark::DoNotOptimize(divergence);
  }
}
BENCHMARK(stableDivergenceOfFourTerms);

struct Example {
  TermRows terms;
  BreadthFirstTree tree;
};

const Example& example() {
  static const Example instance = [] {
    random_trees::Engine random(1);
    random_trees::Shape shape{7, 8, 8, 0.65};
    shape.numClasses = 4;
    const auto tree = random_trees::makeTree(shape, random);
    std::vector<VectorTree::Node> nodes;
    TermRows terms(fourTerms(), 4);
    auto flat = layOutBreadthFirst(tree, terms, nodes);
    return Example{std::move(terms), std::move(flat)};
  }();
  return instance;
}

void countNodes(benchmark::State& state) {
  const auto nodes = static_cast<double>(example().tree.size());
  state.counters["nodes"] = nodes;
  state.counters["time/node"] = benchmark::Counter(
      nodes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void informationOfTree(benchmark::State& state, DivergenceForm form) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(computeInformation(example().tree, example().terms, form));
  }
  countNodes(state);
}
BENCHMARK_CAPTURE(informationOfTree, stable, DivergenceForm::Stable)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(informationOfTree, fast, DivergenceForm::Fast)->Unit(benchmark::kMillisecond);

void searchWithoutLogarithms(benchmark::State& state) {
  const auto information = computeInformation(example().tree, example().terms);
  const auto weights = fourTerms();
  for (auto _ : state) {
    const auto values = computeG(example().tree, information, weights);
    benchmark::DoNotOptimize(expandedNodes(example().tree, values, weights.eps()));
  }
  countNodes(state);
}
BENCHMARK(searchWithoutLogarithms)->Unit(benchmark::kMillisecond);

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
