#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "Plain.h"
#include "Tasks.h"
#include "simulated_drive/DriveLoop.h"

using namespace drive_study;
using Eigen::Vector2d;
using mrpt::math::TPose2D;

namespace {

constexpr double kHalf = 30, kFar = 60;  // m

/** A garden with a goal behind a hedge. */
struct Garden {
  synthetic_world::World world;
  TPose2D start, goal;
};

/** A bent hedge between start and goal, 11 to 15 m apart, that has one end 6 to 20 m aside, half of
 * them with a hook there, and goes on 6 to 20 m or to the garden's border on the other side; a road
 * on either side and, mostly, around the end. */
Garden garden(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const double side = between(0, 1) < 0.5 ? -1 : 1;
  const double end = between(6, 20), other = between(0, 1) < 0.5 ? kHalf : between(end, 22);
  std::vector<Vector2d> hedge;
  for (double y = -other; y < end - 1; y += 4)
    hedge.emplace_back(std::abs(y) < 3 ? 0 : between(-1.5, 1.5), y);
  hedge.emplace_back(0, end);
  if (between(0, 1) < 0.5)
    hedge.emplace_back(between(0, 1) < 0.5 ? -between(2, 5) : between(2, 5), end - between(0, 4));
  synthetic_world::Solids solids;
  for (std::size_t i = 1; i < hedge.size(); ++i) {
    const Vector2d a = hedge[i - 1], b = hedge[i];
    const auto panel =
        synthetic_world::hedgePanel({a.x(), side * a.y(), 0}, {b.x(), side * b.y(), 0});
    solids.insert(solids.end(), panel.begin(), panel.end());
  }
  const double left = between(-8, -5.5), right = between(5.5, 8), turn = end + between(3, 5);
  synthetic_world::GroundCover cover(kHalf, synthetic_world::kGrass);
  const auto road = [&](const Vector2d& a, const Vector2d& b) {
    cover.paintBand(synthetic_world::kRoad, {a.x(), side * a.y()}, {b.x(), side * b.y()}, 4);
  };
  road({left, -28}, {left, 28}), road({right, -28}, {right, 28});
  if (between(0, 1) < 0.7) road({left, turn}, {right, turn});
  return {synthetic_world::World(synthetic_world::Terrain(kHalf, {}), cover, std::move(solids)),
          {left, 0, between(-M_PI, M_PI)},
          {right, 0, between(-M_PI, M_PI)}};
}

/** A goal behind a hedge that ends 25 m behind the robot, and ahead of it at the garden's border,
 * so that there is always hope for a gap just beyond what is seen. */
Garden lane() {
  synthetic_world::Solids solids;
  for (double y = -25; y < kFar; y += 5) {
    const auto panel = synthetic_world::hedgePanel({0, y, 0}, {0, y + 5, 0});
    solids.insert(solids.end(), panel.begin(), panel.end());
  }
  synthetic_world::GroundCover cover(kFar, synthetic_world::kGrass);
  for (const double x : {-6.0, 6.0})
    cover.paintBand(synthetic_world::kRoad, {x, -28}, {x, kFar - 2}, 4);
  return {synthetic_world::World(synthetic_world::Terrain(kFar, {}), cover, std::move(solids)),
          {-6, 0, M_PI / 2},
          {6, 8, M_PI / 2}};
}

/** How many gardens: MSO_HEDGES of the environment, or a few. */
std::uint32_t gardens() {
  const char* text = std::getenv("MSO_HEDGES");
  return text ? static_cast<std::uint32_t>(std::atoi(text)) : 3;
}

}  // namespace

TEST(Hedges, DoNotKeepARobotFromAGoalBehindThem) {
  const auto order = syntheticOrder();
  auto config = smallConfig();
  config.timeLimit = 400;
  std::uint32_t within = 0;
  for (std::uint32_t seed = 1; seed <= gardens(); ++seed) {
    Garden g = garden(seed);
    Task task;
    task.start = g.start, task.goal = g.goal;
    Oracle(g.world, order, config.planner, config.voxelSize).solve(task);
    ASSERT_TRUE(task.hasPath) << seed << ": " << task.reason;
    simulated_drive::DriveLoop loop(config, g.world, order, g.start, g.goal, {});
    const simulated_drive::DriveRecord& record = loop.run();
    EXPECT_EQ(record.end, simulated_drive::DriveEnd::Arrived) << seed << ": " << record.reason;
    EXPECT_EQ(record.collisions, 0) << seed;
    RecordProperty("meters_of_garden_" + std::to_string(seed),
                   std::to_string(record.length) + " of " + std::to_string(task.length));
    within += record.arrived() && record.length <= 3 * task.length ? 1 : 0;
  }
  EXPECT_GE(10 * within, 9 * gardens());
}

TEST(Hedges, AreNotFollowedToTheirEndHoweverFar) {
  auto config = smallConfig();
  config.timeLimit = 400;
  Garden g = lane();
  const auto order = syntheticOrder();
  simulated_drive::DriveLoop loop(config, g.world, order, g.start, g.goal, {});
  const simulated_drive::DriveRecord& record = loop.run();
  EXPECT_EQ(record.end, simulated_drive::DriveEnd::Arrived) << record.reason;
  double farthest = 0;
  for (const simulated_drive::DriveRow& row : record.rows)
    farthest = std::max(farthest, row.pose.y);
  RecordProperty("farthest", std::to_string(farthest));
  RecordProperty("driven", std::to_string(record.length));
  EXPECT_LT(farthest, 0.6 * kFar);
}
