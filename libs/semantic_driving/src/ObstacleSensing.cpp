#include <semantic_driving/ObstacleSensing.h>

#include "Surroundings.h"

namespace semantic_driving {

using namespace semantic_planning;

ObstaclePoints senseObstacles(const SemanticPlanner& planner, const mrpt::math::TPose2D& pose,
                              double z, const ObstacleOptions& options) {
  const Ground& ground = planner.ground();
  ObstaclePoints obstacles;
  const Column center = ground.columnAt(pose.x, pose.y);
  const int reach = static_cast<int>(std::ceil(options.radius / ground.voxelSize()));
  const ColumnRectangle square = ColumnRectangle::around(center, reach);
  const Surroundings surroundings(ground, square, center, ground.keyOf(z));
  surroundings.forEach([&](Column c, int height, const Surface* surface) {
    const int x = c.x - center.x, y = c.y - center.y;
    if (x * x + y * y > reach * reach) return;
    if (!isObstacle(planner, options, c, height, surface)) return;
    const auto p = pose.inverseComposePoint({ground.centerOf(c.x), ground.centerOf(c.y)});
    obstacles.emplace_back(p.x, p.y);
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
