#pragma once
#include <semantic_driving/ObstacleSensing.h>

#include <cmath>

namespace semantic_driving {

/** Which columns are obstacles at a height of the ground. */
class ObstacleFinder {
 public:
  ObstacleFinder(const semantic_planning::SemanticPlanner& planner, const ObstacleOptions& options)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_options(options),
        m_height(
            static_cast<int>(std::ceil(planner.options().vehicle.height / m_ground.voxelSize()))) {}

  bool isObstacle(semantic_planning::Column c, int z,
                  const semantic_planning::Surface* surface) const {
    if (!surface)
      return m_options.unknown || m_ground.isOccupied(c, z + m_ground.step() + 1, z + m_height);
    if (!surface->drivable) return true;
    return m_options.forbiddenGround && !surface->filled &&
           m_planner.order().rank(surface->classId) == colored_graph::kForbidden;
  }

  /** f(k) for the heights in voxels (1: on the ground) where an obstacle of the column is. */
  template <class F>
  void forHeights(semantic_planning::Column c, int z, const semantic_planning::Surface* surface,
                  F f) const {
    for (int k = surface ? 1 : m_ground.step() + 1; k <= m_height; ++k)
      if (surface || m_ground.isOccupied(c, z + k, z + k)) f(k);
  }

 private:
  const semantic_planning::SemanticPlanner& m_planner;
  const semantic_planning::Ground& m_ground;
  const ObstacleOptions& m_options;
  int m_height;
};

}  // namespace semantic_driving
