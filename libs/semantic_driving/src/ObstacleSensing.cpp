#include <semantic_driving/ObstacleSensing.h>

#include <cmath>

#include "Surroundings.h"

namespace semantic_driving {

using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::SemanticPlanner;
using semantic_planning::Surface;

void ObstacleOptions::describe(strict_files::OptionList& list) {
  list.add("radius", radius, "m", strict_files::above(0), "how far obstacles are looked for");
  list.add("forbidden_ground", forbiddenGround, "",
           "ground of forbidden classes is an obstacle, even when flat");
}

void ObstacleOptions::validate() const { strict_files::checkOptions(*this, "ObstacleOptions"); }

namespace {

class ObstacleFinder {
 public:
  ObstacleFinder(const SemanticPlanner& planner, const ObstacleOptions& options)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_options(options),
        m_height(
            static_cast<int>(std::ceil(planner.options().vehicle.height / m_ground.voxelSize()))) {}

  bool isObstacle(Column c, int z, const Surface* surface) const {
    if (!surface) return anyOccupied(c, z);
    if (!surface->drivable) return true;
    return m_options.forbiddenGround && !surface->filled &&
           m_planner.order().rank(surface->classId) == colored_graph::kForbidden;
  }

  /** f(k) for the heights in voxels (1: on the ground) where an obstacle of the column is. */
  template <class F>
  void forHeights(Column c, int z, const Surface* surface, F f) const {
    for (int k = surface ? 1 : m_ground.step() + 1; k <= m_height; ++k)
      if (surface || isOccupied(c, z + k)) f(k);
  }

 private:
  bool anyOccupied(Column c, int z) const {
    for (int k = m_ground.step() + 1; k <= m_height; ++k)
      if (isOccupied(c, z + k)) return true;
    return false;
  }

  bool isOccupied(Column c, int z) const {
    const auto& map = m_ground.map();
    const auto node = map.search(octomap::OcTreeKey(static_cast<octomap::key_type>(c.x),
                                                     static_cast<octomap::key_type>(c.y),
                                                     static_cast<octomap::key_type>(z)));
    return node && map.isNodeOccupied(node);
  }

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  const ObstacleOptions& m_options;
  int m_height;
};

/** f(finder, column, height, surface, place in the vehicle's frame) for all obstacles. */
template <class F>
void forObstacles(const SemanticPlanner& planner, const mrpt::math::TPose2D& pose, double z,
                  const ObstacleOptions& options, F f) {
  options.validate();
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

}  // namespace semantic_driving
