#include <semantic_driving/ObstacleSensing.h>

#include <algorithm>
#include <cmath>

#include "Surroundings.h"

namespace semantic_driving {

using semantic_octree::Abstraction;
using semantic_octree::LeafCell;
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

namespace {

bool meets(const LeafCell& leaf, int lowest, int highest) {
  return leaf.lowest.z() <= highest && leaf.lowest.z() + leaf.edge() > lowest;
}

class CompressedFinder {
 public:
  CompressedFinder(const SemanticPlanner& planner, const Surroundings& surroundings,
                   const ObstacleOptions& options)
      : m_planner(planner),
        m_ground(planner.ground()),
        m_surroundings(surroundings),
        m_options(options),
        m_height(
            static_cast<int>(std::ceil(planner.options().vehicle.height / m_ground.voxelSize()))),
        m_columns(surroundings.columns()),
        m_covered(m_columns.size(), false) {}

  /** All leaves that are in the way. */
  void cover(const Abstraction& compressed) {
    const auto key = [](Column c, int z) {
      const auto part = [](int k) {
        return static_cast<octomap::key_type>(std::clamp(k, 0, 65535));
      };
      return octomap::OcTreeKey(part(c.x), part(c.y), part(z));
    };
    int lowest = 65535, highest = 0;
    m_surroundings.forEach([&](Column, int z, const Surface*) {
      lowest = std::min(lowest, z), highest = std::max(highest, z);
    });
    const int step = m_ground.step();
    for (const LeafCell& leaf :
         compressed.leavesIn(key(m_columns.low(), lowest - step),
                             key(m_columns.high(), highest + m_height + step), true))
      if (isInTheWay(leaf)) mark(leaf);
    m_surroundings.forEach([&](Column c, int, const Surface* s) {  // no leaf is there
      if (s && s->filled && !s->drivable) m_covered[m_columns.indexOf(c)] = true;
    });
  }

  /** f(column) for what is covered and next to what is not. */
  template <class F>
  void forBorder(F f) const {
    m_surroundings.forEach([&](Column c, int, const Surface*) {
      const auto covered = [&](int x, int y) {
        const Column next{c.x + x, c.y + y};
        return m_surroundings.isWithinRadius(next) && m_covered[m_columns.indexOf(next)];
      };
      const bool inside = covered(1, 0) && covered(-1, 0) && covered(0, 1) && covered(0, -1);
      if (covered(0, 0) && !inside) f(c);
    });
  }

 private:
  template <class Predicate>
  bool anyColumn(const LeafCell& leaf, Predicate predicate) const {
    for (int y = leaf.lowest.y(); y < leaf.lowest.y() + leaf.edge(); ++y)
      for (int x = leaf.lowest.x(); x < leaf.lowest.x() + leaf.edge(); ++x)
        if (m_surroundings.contains({x, y}) && predicate(Column{x, y})) return true;
    return false;
  }

  bool isInTheWay(const LeafCell& leaf) const {
    const int step = m_ground.step();
    return anyColumn(leaf, [&](Column c) {
      const int z = m_surroundings.height(c);
      const Surface* s = m_ground.near(c, z, step);
      if (!s) return meets(leaf, z + step + 1, z + m_height);
      return isBad(*s) && meets(leaf, s->z, s->z);
    });
  }
  bool isBad(const Surface& s) const {
    return !s.drivable || (m_options.forbiddenGround && !s.filled &&
                           m_planner.order().rank(s.classId) == colored_graph::kForbidden);
  }
  void mark(const LeafCell& leaf) {
    anyColumn(leaf, [&](Column c) {
      m_covered[m_columns.indexOf(c)] = true;
      return false;
    });
  }

  const SemanticPlanner& m_planner;
  const Ground& m_ground;
  const Surroundings& m_surroundings;
  const ObstacleOptions& m_options;
  int m_height;
  const ColumnRectangle& m_columns;
  std::vector<bool> m_covered;
};

}  // namespace

ObstaclePoints senseCompressedObstacles(const SemanticPlanner& planner,
                                        const Abstraction& compressed,
                                        const mrpt::math::TPose2D& pose, double z,
                                        const ObstacleOptions& options) {
  const Ground& ground = planner.ground();
  const int key = ground.keyOf(z);
  const Surroundings surroundings(ground, pose, key, options.radius);
  CompressedFinder finder(planner, surroundings, options);
  finder.cover(compressed);
  ObstaclePoints obstacles;
  finder.forBorder([&](Column c) {
    const auto p = pose.inverseComposePoint({ground.centerOf(c.x), ground.centerOf(c.y)});
    obstacles.emplace_back(p.x, p.y);
  });
  return obstacles;
}

}  // namespace semantic_driving
