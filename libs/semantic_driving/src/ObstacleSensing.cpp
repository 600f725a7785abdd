#include <semantic_driving/ObstacleSensing.h>

#include <cmath>

#include "ObstacleFinder.h"
#include "Surroundings.h"

namespace semantic_driving {

using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::SemanticPlanner;
using semantic_planning::Surface;

namespace {

/** f(finder, column, height, surface, place in the vehicle's frame) for all obstacles. */
template <class F>
void forObstacles(const SemanticPlanner& planner, const mrpt::math::TPose2D& pose, double z,
                  const ObstacleOptions& options, F f) {
  const Ground& ground = planner.ground();
  const ObstacleFinder finder(planner, options);
  const int key = ground.keyOf(z);
  Surroundings(ground, pose, key, options.radius).forEach([&](Column c, int height, auto* surface) {
    if (!finder.isObstacle(c, height, surface)) return;
    f(finder, c, height, surface,
      pose.inverseComposePoint({ground.centerOf(c.x), ground.centerOf(c.y)}));
  });
}

}  // namespace

ObstaclePoints senseObstacles(const SemanticPlanner& planner, const mrpt::math::TPose2D& pose,
                              double z, const ObstacleOptions& options) {
  ObstaclePoints obstacles;
  forObstacles(planner, pose, z, options,
               [&](auto&, Column, int, auto*, const mrpt::math::TPoint2D& p) {
                 obstacles.emplace_back(p.x, p.y);
               });
  return obstacles;
}

ObstaclePoints3 senseObstacles3(const SemanticPlanner& planner, const mrpt::math::TPose2D& pose,
                                double z, const ObstacleOptions& options) {
  ObstaclePoints3 obstacles;
  const double edge = planner.ground().voxelSize();
  forObstacles(planner, pose, z, options,
               [&](auto& finder, Column c, int height, auto* surface, const auto& p) {
                 finder.forHeights(c, height, surface, [&](int k) {
                   obstacles.emplace_back(p.x, p.y, (k - 0.5) * edge);
                 });
               });
  return obstacles;
}

ObstaclePoints seenFrom(const ObstaclePoints& obstacles, const mrpt::math::TPose2D& from,
                        const mrpt::math::TPose2D& to, double radius) {
  const mrpt::math::TPose2D T_to_from = from - to;
  ObstaclePoints seen;
  for (const Eigen::Vector2d& p : obstacles) {
    const auto there = T_to_from.composePoint({p.x(), p.y()});
    if (there.norm() <= radius) seen.emplace_back(there.x, there.y);
  }
  return seen;
}

}  // namespace semantic_driving
