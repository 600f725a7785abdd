// Looking at edges between poses in a town: as far from each other as neighbors of a roadmap are.
#include <benchmark/benchmark.h>
#include <semantic_planning/roadmap/CollisionChecker.h>

#include <algorithm>
#include <random>
#include <vector>

#include "Town.h"

using namespace semantic_planning;

namespace {

/** Free poses, each a neighbor of the one before. */
std::vector<GroundPose> walkThroughTown(const CollisionChecker& checker) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> step(-1.5, 1.5), heading(-M_PI, M_PI);
  std::vector<GroundPose> poses{*checker.place({-47, -47, 0})};
  while (poses.size() < 4096) {
    const mrpt::math::TPose2D& last = poses.back().pose;
    const auto next =
        checker.place({last.x + step(random), last.y + step(random), heading(random)});
    if (next && checker.fit(*next) == Fit::Free) poses.push_back(*next);
  }
  return poses;
}

void profile(benchmark::State& state) {
  const VehicleOptions vehicle;  // turning radius 1 m
  const Ground ground(town::map(), vehicle, {}, town::order());
  const CollisionChecker checker(ground, vehicle, town::order(), {});
  const std::vector<GroundPose> poses = walkThroughTown(checker);
  std::size_t i = 0, blocked = 0;
  double meters = 0;
  for (auto _ : state) {
    const GroundPose &a = poses[i % 4095], &b = poses[i % 4095 + 1];
    ++i;
    blocked += !checker.profile(a, b);
    if (i < 4096) meters += checker.reedsShepp().distance(a.pose, b.pose);
  }
  state.counters["blocked"] = double(blocked) / double(i);
  state.counters["meters"] = meters / double(std::min<std::size_t>(i, 4095));
}
BENCHMARK(profile);

}  // namespace
