#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_driving/ObstacleSensing.h>
#include <semantic_planning/planner/OrderFile.h>
#include <synthetic_world/Objects.h>

#include <algorithm>
#include <cmath>

#include "../semantic_planning/PaintedWorld.h"

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

  semantic_octree::SemanticOcTree& map() {
    semantic_octree::SemanticOcTree& m = world.map();
    if (!hasAbstraction(m)) setAbstraction(m, abstractionFor(order));
    return m;
  }
  SemanticPlanner planner() { return SemanticPlanner(map(), order, {}); }

  PaintedWorld world;
  colored_graph::ClassOrder order{5, {{1}, {2}, {0}}};
};

bool contains(const ObstaclePoints& points, double x, double y) {
  return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return (p - Eigen::Vector2d(x, y)).norm() < 1e-3;
  });
}

/** Whether a point lies within the outline of points on a grid: none is left of it, say. */
bool isEnclosed(const ObstaclePoints& border, const Eigen::Vector2d& p) {
  const auto any = [&](auto predicate) {
    return std::any_of(border.begin(), border.end(), [&](const Eigen::Vector2d& b) {
      return predicate(b.x() - p.x(), b.y() - p.y());
    });
  };
  constexpr double kSame = 1e-3;
  return any([](double x, double y) { return std::abs(y) < kSame && x > -kSame; }) &&
         any([](double x, double y) { return std::abs(y) < kSame && x < kSame; }) &&
         any([](double x, double y) { return std::abs(x) < kSame && y > -kSame; }) &&
         any([](double x, double y) { return std::abs(x) < kSame && y < kSame; });
}

}  // namespace

TEST_F(ObstacleSensing, FindsWallsPostsAndForbiddenGround) {
  SemanticPlanner planner = this->planner();
  planner.plan({0, 0, 0}, {0, -3, 0});
  const ObstaclePoints points = senseObstacles(planner, {0, 0, 0}, 0);
  EXPECT_TRUE(contains(points, 3.1, 0.1));
  EXPECT_TRUE(contains(points, -2.9, 1.1));
  EXPECT_TRUE(contains(points, 3.1, -3.1));
  EXPECT_FALSE(contains(points, 1.1, 0.1));
  ObstacleOptions free;
  free.forbiddenGround = false;
  EXPECT_FALSE(contains(senseObstacles(planner, {0, 0, 0}, 0, free), 3.1, -3.1));
}

TEST_F(ObstacleSensing, IsInTheVehiclesFrame) {
  SemanticPlanner planner = this->planner();
  planner.plan({0, 0, 0}, {0, -3, 0});
  const ObstaclePoints points = senseObstacles(planner, {1, 1, M_PI / 2}, 0);
  EXPECT_TRUE(contains(points, -0.9, -2.1));  // the wall at (3.1, 0.1)
}

TEST_F(ObstacleSensing, TellsHeightsOfWhatHangsAbove) {
  world.box(0, 0.2, 3, 3.2, 0.6, 0.8, PaintedWorld::Wall);
  map();
  world.floor(-0.2, 0.4, 2.8, 3.4, PaintedWorld::Road);  // the ground below, seen from the side
  world.map({0.1, 6, 0.4});
  SemanticPlanner planner = this->planner();
  planner.plan({0, 0, 0}, {0, -3, 0});
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : senseObstacles3(planner, {0, 0, 0}, 0))
    if (std::abs(p.x() - 0.1) < 1e-3 && std::abs(p.y() - 3.1) < 1e-3) heights.push_back(p.z());
  ASSERT_EQ(heights.size(), 1u);
  EXPECT_NEAR(heights[0], 0.7, 1e-6);
}

TEST_F(ObstacleSensing, OfTheCompressedTreeMissesNothing) {
  SemanticPlanner planner = this->planner();
  planner.plan({0, 0, 0}, {0, -3, 0});
  const semantic_octree::Abstraction compressed(map());
  for (const mrpt::math::TPose2D& pose : {mrpt::math::TPose2D(0, 0, 0), {1, -1, 0.5}, {-2, 3, 2}}) {
    const ObstaclePoints full = senseObstacles(planner, pose, 0);
    const ObstaclePoints border = senseCompressedObstacles(planner, compressed, pose, 0);
    ObstaclePoints mapBorder;  // grids are parallel to the axes in the map's frame only
    const auto inMap = [&](const Eigen::Vector2d& p) {
      const auto q = pose.composePoint({p.x(), p.y()});
      return Eigen::Vector2d(q.x, q.y);
    };
    for (const Eigen::Vector2d& p : border) mapBorder.push_back(inMap(p));
    EXPECT_FALSE(full.empty());
    for (const Eigen::Vector2d& p : full) {
      EXPECT_TRUE(isEnclosed(mapBorder, inMap(p))) << inMap(p).transpose();
    }
  }
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
