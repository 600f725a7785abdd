#pragma once
#include <semantic_driving/ObstacleSensing.h>

#include <array>
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
    if (!surface) return m_options.unknown || anyOccupied(c, z);
    if (!surface->drivable) return true;
    return m_options.forbiddenGround && !surface->filled &&
           m_planner.order().rank(surface->classId) == colored_graph::kForbidden;
  }

  /** f(k) for the heights in voxels (1: on the ground) where an obstacle of the column is. */
  template <class F>
  void forHeights(semantic_planning::Column c, int z, const semantic_planning::Surface* surface,
                  F f) const {
    for (int k = surface ? 1 : m_ground.step() + 1; k <= m_height; ++k)
      if (surface || isOccupied(c, z + k)) f(k);
  }

 private:
  bool anyOccupied(semantic_planning::Column c, int z) const {
    if (isUnknownAround(c, z)) return false;
    for (int k = m_ground.step() + 1; k <= m_height; ++k)
      if (isOccupied(c, z + k)) return true;
    return false;
  }

  /** The map has nothing of the block of columns at any height of an obstacle. The last answer is
   * kept, since columns are asked for in rows. */
  bool isUnknownAround(semantic_planning::Column c, int z) const {
    constexpr int kBits = 3;  // 8 x 8 x 8 voxels
    const Block block{c.x >> kBits, c.y >> kBits, (z + m_ground.step() + 1) >> kBits,
                      (z + m_height) >> kBits};
    if (block == m_block) return m_blockIsUnknown;
    m_block = block;
    m_blockIsUnknown = true;
    const unsigned depth = m_ground.map().getTreeDepth() - kBits;
    for (int k = block[2]; k <= block[3] && m_blockIsUnknown; ++k)
      m_blockIsUnknown = !m_ground.map().search(keyOf(c, k << kBits), depth);
    return m_blockIsUnknown;
  }

  bool isOccupied(semantic_planning::Column c, int z) const {
    const auto& map = m_ground.map();
    const auto node = map.search(keyOf(c, z));
    return node && map.isNodeOccupied(node);
  }

  static octomap::OcTreeKey keyOf(semantic_planning::Column c, int z) {
    return octomap::OcTreeKey(static_cast<octomap::key_type>(c.x),
                              static_cast<octomap::key_type>(c.y),
                              static_cast<octomap::key_type>(z));
  }

  const semantic_planning::SemanticPlanner& m_planner;
  const semantic_planning::Ground& m_ground;
  const ObstacleOptions& m_options;
  int m_height;
  using Block = std::array<int, 4>;  // x, y, lowest and highest z
  mutable Block m_block{};
  mutable bool m_blockIsUnknown = false;
};

}  // namespace semantic_driving
