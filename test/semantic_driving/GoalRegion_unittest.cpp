#include "GoalRegion.h"

#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>

#include <cmath>
#include <set>

#include "PaintedPlanner.h"

using namespace semantic_driving;
using namespace semantic_planning;

namespace {

constexpr double kRegionVoxel = 0.2;  // m
constexpr double kDisc = 0.35;        // m: the footprint's inner radius, and the clearance
constexpr int kReach = 20;            // columns
constexpr int kAroundGoal = 5;        // columns, 1 m

using Place = std::pair<int, int>;  ///< a column, counted from the origin

/** Flat ground with walls, as painted. */
struct Walls {
  std::set<Place> columns;

  bool contains(int x, int y) const { return columns.count({x, y}) > 0; }
  /** A pose in the column is too near to a wall, wherever in it. */
  bool keep(int x, int y) const {
    for (const auto& [wx, wy] : columns)
      if (kRegionVoxel * std::hypot(wx - x, wy - y) < kDisc - 1e-5) return true;
    return false;
  }
  SemanticPlanner planner(PaintedWorld& world) const {
    world.floor(-6, 6, -6, 6, PaintedWorld::Road);
    for (const auto& [x, y] : columns)
      for (int z = 0; z < 5; ++z) world.voxel(x, y, z, PaintedWorld::Wall);
    return plannerOver(world);
  }
};

/** What GoalRegion says it is, by spreading until nothing changes any more. */
struct FloodedRegion {
  std::set<Place> region;
  bool open = false, enclosed = true;

  FloodedRegion(const Walls& walls, const std::set<Place>& reached, const Place& goal) {
    const auto take = [&](int x, int y) {
      const int far = std::max(std::abs(x), std::abs(y));
      if (far > kReach || (far < kReach && walls.keep(x, y))) return;
      const bool isReached = reached.count({x, y}) > 0;
      if (isReached) enclosed = false;
      if (far == kReach) open = true;
      if (!isReached || far == kReach) region.insert({x, y});
    };
    const auto seed = [&](bool kept) {
      for (int x = -kAroundGoal; x <= kAroundGoal; ++x)
        for (int y = -kAroundGoal; y <= kAroundGoal; ++y)
          if (kept ? std::hypot(x, y) <= kAroundGoal : x == 0 && y == 0)
            take(goal.first + x, goal.second + y);
    };
    seed(walls.keep(goal.first, goal.second));
    for (std::size_t before = 0; before != region.size();) {
      before = region.size();
      for (const auto& [x, y] : std::set<Place>(region))
        for (int dx = -1; dx <= 1; ++dx)
          for (int dy = -1; dy <= 1; ++dy) take(x + dx, y + dy);
    }
  }
};

Walls randomWalls(synthetic_world::Random& random) {
  Walls walls;
  const int count = 6 + random.below(8);
  for (int i = 0; i < count; ++i) {
    const int x = random.below(31) - 15, y = random.below(31) - 15, length = 5 + random.below(14);
    const bool along = random.chance(0.5);
    for (int k = 0; k < length; ++k) {
      const Place c(along ? x + k : x, along ? y : y + k);
      if (std::abs(c.first) < 4 && std::abs(c.second) < 4) continue;  // where the vehicle stands
      if (std::hypot(c.first, c.second) > kReach) continue;           // it is not seen
      walls.columns.insert(c);
    }
  }
  return walls;
}

Column columnOf(const Place& place) { return {32768 + place.first, 32768 + place.second}; }
mrpt::math::TPose2D poseIn(const Place& place) {
  return {(place.first + 0.5) * kRegionVoxel, (place.second + 0.5) * kRegionVoxel, 0};
}

GoalRegion regionOf(const SemanticPlanner& planner, const std::set<Place>& reached,
                    const Place& goal) {
  const ColumnRectangle columns = ColumnRectangle::around(columnOf({0, 0}), kReach);
  std::vector<bool> marked(columns.size());
  for (const Place& p : reached) marked[columns.indexOf(columnOf(p))] = true;
  return GoalRegion(planner, columns, marked, poseIn({0, 0}), 0, poseIn(goal));
}

/** Free places around the vehicle. */
std::set<Place> discWithout(const Walls& walls, double radius) {
  std::set<Place> places;
  for (int x = -kReach; x <= kReach; ++x)
    for (int y = -kReach; y <= kReach; ++y)
      if (std::hypot(x, y) <= radius && !walls.keep(x, y)) places.insert({x, y});
  return places;
}

}  // namespace

TEST(GoalRegion, IsThatOfAFloodByHandAmongRandomWalls) {
  synthetic_world::Random random(1);
  int enclosed = 0, open = 0;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const Walls walls = randomWalls(random);
    const std::set<Place> reached = discWithout(walls, 3 + random.below(8));
    const Place goal(random.below(33) - 16, random.below(33) - 16);
    if (reached.count(goal)) continue;
    PaintedWorld world;
    const SemanticPlanner planner = walls.planner(world);
    const GoalRegion region = regionOf(planner, reached, goal);
    const FloodedRegion oracle(walls, reached, goal);
    EXPECT_EQ(region.isEnclosed(), oracle.enclosed);
    EXPECT_EQ(region.isOpen(), oracle.open);
    EXPECT_EQ(region.columns(), oracle.region.size());
    for (int x = -kReach; x <= kReach; ++x)
      for (int y = -kReach; y <= kReach; ++y) {
        EXPECT_EQ(region.contains(columnOf({x, y})), oracle.region.count({x, y}) > 0)
            << x << ", " << y;
        EXPECT_EQ(region.isObstacle(columnOf({x, y})), walls.contains(x, y)) << x << ", " << y;
      }
    enclosed += oracle.enclosed, open += oracle.open;
  }
  EXPECT_GT(open, 0);
  EXPECT_LT(enclosed, 20);
}

TEST(GoalRegion, ThatTheVehicleReachesIsNotEnclosed) {
  PaintedWorld world;
  const SemanticPlanner planner = Walls().planner(world);
  const GoalRegion region = regionOf(planner, {{11, 0}}, {11, 0});
  EXPECT_FALSE(region.isEnclosed());
  EXPECT_TRUE(region.contains(columnOf({-9, -9})));  // wherever: a plan may come from there
}

TEST(GoalRegion, LeadsThroughGapsThatTheVehicleGetsThrough) {
  Walls walls;
  for (int y = -12; y <= 12; ++y)
    if (y != 0) walls.columns.insert({15, y});
  std::set<Place> reached;
  for (int x = 11; x <= 18; ++x) reached.insert({x, 0});
  PaintedWorld world;
  const SemanticPlanner planner = walls.planner(world);
  const GoalRegion region = regionOf(planner, reached, {11, 0});
  EXPECT_NEAR(region.way(columnOf({18, 0})), 7 * kRegionVoxel, 1e-9);
  EXPECT_NEAR(region.way(columnOf({18, 2})), (5 + 2 * std::sqrt(2)) * kRegionVoxel, 1e-9);
}
