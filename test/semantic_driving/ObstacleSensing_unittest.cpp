#include <gtest/gtest.h>
#include <semantic_driving/ObstacleSensing.h>
#include <synthetic_world/Objects.h>

#include <algorithm>
#include <cmath>

#include "PaintedPlanner.h"

using namespace semantic_driving;
using namespace semantic_planning;

namespace {

/** A road with a wall, a post, and mud, which is forbidden here. */
class ObstacleSensing : public testing::Test {
 protected:
  ObstacleSensing() {
    world.floor(-8, 8, -8, 8, PaintedWorld::Road);
    world.floor(2, 8, -8, -2, PaintedWorld::Mud);
    world.box(3, 3.2, -1, 5, 0, 1, PaintedWorld::Wall);
    world.box(-3, -2.8, 1, 1.2, 0, 1, PaintedWorld::Wall);
  }

  PaintedWorld world;
};

bool hasPoint(const ObstaclePoints& points, double x, double y) {
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return (p - Eigen::Vector2d(x, y)).norm() < 1e-3;
  });
}

}  // namespace

TEST_F(ObstacleSensing, FindsWallsPostsAndForbiddenGround) {
  const SemanticPlanner planner = plannerOver(world);
  const ObstaclePoints points = senseObstacles(planner, {0, 0, 0}, 0);
  EXPECT_TRUE(hasPoint(points, 3.1, 0.1));
  EXPECT_TRUE(hasPoint(points, -2.9, 1.1));
  EXPECT_TRUE(hasPoint(points, 3.1, -3.1));
  EXPECT_FALSE(hasPoint(points, 1.1, 0.1));
  ObstacleOptions free;
  free.forbiddenGround = false;
  EXPECT_FALSE(hasPoint(senseObstacles(planner, {0, 0, 0}, 0, free), 3.1, -3.1));
}

TEST_F(ObstacleSensing, IsInTheVehiclesFrame) {
  const SemanticPlanner planner = plannerOver(world);
  const ObstaclePoints points = senseObstacles(planner, {1, 1, M_PI / 2}, 0);
  EXPECT_TRUE(hasPoint(points, -0.9, -2.1));  // the wall at (3.1, 0.1)
}

TEST(SeenFrom, IsWhereTheObstaclesAreForTheVehicleAfterItsMotion) {
  const mrpt::math::TPose2D from(3, -2, 0.4), to(4.5, -1, 1.7);
  synthetic_world::Random random(5);
  ObstaclePoints obstacles;
  for (int i = 0; i < 200; ++i) obstacles.emplace_back(6 * random.normal(), 6 * random.normal());
  const ObstaclePoints seen = semantic_driving::seenFrom(obstacles, from, to, 5);
  ObstaclePoints expected;
  for (const Eigen::Vector2d& p : obstacles) {
    const Eigen::Vector2d inMap =
        Eigen::Vector2d(from.x, from.y) + Eigen::Rotation2Dd(from.phi) * p;
    const Eigen::Vector2d there =
        Eigen::Rotation2Dd(-to.phi) * (inMap - Eigen::Vector2d(to.x, to.y));
    if (there.norm() <= 5) expected.push_back(there);
  }
  ASSERT_GT(expected.size(), 20u);
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_LT((seen[i] - expected[i]).norm(), 1e-12) << i;
}
