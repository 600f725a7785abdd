// Shortest curves between poses as far from each other as a roadmap's neighbors and candidates are,
// next to OMPL's.
#include <benchmark/benchmark.h>
#include <semantic_planning/vehicle/ReedsShepp.h>

#include <random>
#include <vector>

#include "ReedsSheppOracle.h"

using mrpt::math::TPose2D;
using semantic_planning::ReedsShepp;

namespace {

/** \param box half its edge, in turning radii */
std::vector<TPose2D> posesWithin(double box) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-box, box), heading(-M_PI, M_PI);
  std::vector<TPose2D> poses(4096);
  for (TPose2D& pose : poses) pose = {at(random), at(random), heading(random)};
  return poses;
}

template <class Solve>
void solvePairs(benchmark::State& state, Solve solve) {
  const std::vector<TPose2D> poses = posesWithin(double(state.range(0)));
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve(poses[i % 4096], poses[(i + 1) % 4096]));
    ++i;
  }
}

void distance(benchmark::State& state) {
  const ReedsShepp shepp(1);
  solvePairs(state, [&](const TPose2D& a, const TPose2D& b) { return shepp.distance(a, b); });
}
void connect(benchmark::State& state) {
  const ReedsShepp shepp(1);
  solvePairs(state, [&](const TPose2D& a, const TPose2D& b) { return shepp.connect(a, b); });
}
void distanceOfOmpl(benchmark::State& state) {
  const ReedsSheppOracle ompl(1);
  solvePairs(state, [&](const TPose2D& a, const TPose2D& b) { return ompl.distance(a, b); });
}
BENCHMARK(distance)->ArgName("radii")->Arg(1)->Arg(4)->Arg(10);
BENCHMARK(connect)->ArgName("radii")->Arg(1)->Arg(4)->Arg(10);
BENCHMARK(distanceOfOmpl)->ArgName("radii")->Arg(1)->Arg(4)->Arg(10);

}  // namespace
