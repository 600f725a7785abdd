#include "Instances.h"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace planning_study {

using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

constexpr int kMostTries = 100000;  // for one instance

bool isFree(const CollisionChecker& checker, const TPose2D& pose) {
  const auto placed = checker.place(pose);
  return placed && checker.fit(*placed) == Fit::Free &&
         checker.order().rank(checker.classAt(*placed)) != colored_graph::kForbidden;
}

class PoseDraw {
 public:
  PoseDraw(const CollisionChecker& checker, std::uint64_t seed)
      : m_checker(checker), m_tiles(checker.ground().tiles()), m_random(seed) {
    if (m_tiles.empty()) throw std::runtime_error("the map has no ground");
  }

  /** Nothing if the draw did not hit a place to stand. */
  std::optional<TPose2D> pose() {
    const Ground& ground = m_checker.ground();
    const auto i = static_cast<std::size_t>(unit() * static_cast<double>(m_tiles.size()));
    const Column low = firstColumnOf(m_tiles[i]);
    const double edge = kTileEdge * ground.voxelSize(), half = ground.voxelSize() / 2;
    const double x = ground.centerOf(low.x) - half + unit() * edge;
    const double y = ground.centerOf(low.y) - half + unit() * edge;
    const TPose2D pose(x, y, (2 * unit() - 1) * M_PI);
    return isFree(m_checker, pose) ? std::optional(pose) : std::nullopt;
  }

 private:
  /** In [0, 1), the same with every standard library. */
  double unit() { return std::ldexp(static_cast<double>(m_random() >> 11), -53); }

  const CollisionChecker& m_checker;
  const std::vector<Column> m_tiles;
  std::mt19937_64 m_random;
};

bool isConnected(const Ground& ground, const Instance& instance) {
  const auto a = ground.find(instance.start.x, instance.start.y);
  const auto b = ground.find(instance.goal.x, instance.goal.y);
  return a && b && ground.connected(*a, *b);
}

Instance drawInstance(const CollisionChecker& checker, PoseDraw& draw, double minDistance) {
  for (int i = 0; i < kMostTries; ++i) {
    const auto start = draw.pose(), goal = draw.pose();
    if (!start || !goal) continue;
    const Instance instance{*start, *goal};
    if (std::hypot(goal->x - start->x, goal->y - start->y) >= minDistance &&
        isConnected(checker.ground(), instance))
      return instance;
  }
  throw std::runtime_error("no start and goal on connected ground, " + std::to_string(minDistance) +
                           " m apart, found in " + std::to_string(kMostTries) + " draws");
}

}  // namespace

std::vector<Instance> drawInstances(const CollisionChecker& checker, std::size_t count,
                                    double minDistance, std::uint64_t seed) {
  PoseDraw draw(checker, seed);
  std::vector<Instance> instances;
  while (instances.size() < count) instances.push_back(drawInstance(checker, draw, minDistance));
  return instances;
}

}  // namespace planning_study
