#include <semantic_planning/ObstacleSensing.h>

#include <array>
#include <cmath>
#include <deque>

#include "OptionChecks.h"

namespace semantic_planning {

void ObstacleOptions::validate() const {
  OptionChecks("ObstacleOptions").positive("radius", radius);
}

namespace {

constexpr std::array<Column, 4> kNeighbors = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

/** The columns around a vehicle, each with the height of the ground that leads there. */
class Surroundings {
 public:
  Surroundings(const Ground& ground, const mrpt::math::TPose2D& pose, int z, double radius)
      : m_ground(ground),
        m_center(ground.columnAt(pose.x, pose.y)),
        m_reach(static_cast<int>(std::ceil(radius / ground.voxelSize()))),
        m_edge(2 * m_reach + 1),
        m_heights(static_cast<std::size_t>(m_edge) * m_edge, kNotReached) {
    spread(z);
  }

  /** f(column, key of the ground's height, surface there or null) */
  template <class F>
  void forEach(F f) const {
    for (int y = -m_reach; y <= m_reach; ++y)
      for (int x = -m_reach; x <= m_reach; ++x) {
        if (x * x + y * y > m_reach * m_reach) continue;
        const Column c{m_center.x + x, m_center.y + y};
        const int z = m_heights[indexOf(c)];
        f(c, z, m_ground.near(c, z, m_ground.step()));
      }
  }

 private:
  static constexpr int kNotReached = -1;
  struct Step {
    Column column;
    int z;
  };

  bool contains(Column c) const {
    return std::abs(c.x - m_center.x) <= m_reach && std::abs(c.y - m_center.y) <= m_reach;
  }
  std::size_t indexOf(Column c) const {
    return static_cast<std::size_t>(c.y - m_center.y + m_reach) * m_edge +
           (c.x - m_center.x + m_reach);
  }

  /** Over ground first, so that a detour over it counts for more than a jump over a gap. */
  void spread(int z) {
    std::deque<Step> next{{m_center, z}};
    while (!next.empty()) {
      const Step step = next.front();
      next.pop_front();
      int& height = m_heights[indexOf(step.column)];
      if (height != kNotReached) continue;
      const Surface* here = m_ground.near(step.column, step.z, m_ground.step());
      height = here ? here->z : step.z;
      for (const Column& d : kNeighbors) {
        const Column c{step.column.x + d.x, step.column.y + d.y};
        if (!contains(c) || m_heights[indexOf(c)] != kNotReached) continue;
        if (m_ground.near(c, height, m_ground.step()))
          next.push_front({c, height});
        else
          next.push_back({c, height});
      }
    }
  }

  const Ground& m_ground;
  Column m_center;
  int m_reach, m_edge;
  std::vector<int> m_heights;
};

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
    return m_options.forbiddenGround && !surface->bridged &&
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
    const auto* node = map.search(octomap::OcTreeKey(static_cast<octomap::key_type>(c.x),
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
  const int key = static_cast<int>(std::floor(z / ground.voxelSize())) + 32768;
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

}  // namespace semantic_planning
