#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_driving/ObstacleSensing.h>
#include <semantic_planning/ground/Ground.h>

#include <array>
#include <cmath>
#include <vector>

#include "GroundFlood.h"

namespace semantic_driving {

/** Whether a column is an obstacle where the ground that leads there is at a height.
 * \param surface of the ground there; null: none is known */
inline bool isObstacle(const semantic_planning::SemanticPlanner& planner,
                       const ObstacleOptions& options, semantic_planning::Column c, int z,
                       const semantic_planning::Surface* surface) {
  const semantic_planning::Ground& ground = planner.ground();
  if (!surface) {
    const double height = planner.options().vehicle.height / ground.voxelSize();
    return options.unknown ||
           ground.isOccupied(c, z + ground.step() + 1, z + static_cast<int>(std::ceil(height)));
  }
  if (!surface->drivable) return true;
  return options.forbiddenGround && !surface->filled &&
         planner.order().rank(surface->classId) == colored_graph::kForbidden;
}

/** The columns around a vehicle, each with the height of the ground that leads there. */
class Surroundings {
 public:
  /** \param center in the rectangle, on ground of height z (key) */
  Surroundings(const semantic_planning::Ground& ground, const ColumnRectangle& columns,
               semantic_planning::Column center, int z)
      : m_ground(ground),
        m_columns(columns),
        m_center(center),
        m_heights(columns.size(), kNotReached) {
    spread(z);
  }

  bool contains(semantic_planning::Column c) const { return m_columns.contains(c); }
  /** Key of the ground's height there, or that leads there. \param c contained */
  int height(semantic_planning::Column c) const { return m_heights[m_columns.indexOf(c)]; }

  /** f(column, key of the ground's height, surface there or null) */
  template <class F>
  void forEach(F f) const {
    for (std::size_t i = 0; i < m_heights.size(); ++i) {
      const semantic_planning::Column c = m_columns.columnOf(i);
      f(c, m_heights[i], m_ground.near(c, m_heights[i], m_ground.step()));
    }
  }

 private:
  static constexpr int kNotReached = -1;
  static constexpr std::array<semantic_planning::Column, 4> kNeighbors = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  struct Step {
    semantic_planning::Column column;
    int z;  ///< of the ground there, or that leads there
  };

  /** Over ground first, so that a detour over it counts for more than a jump over a gap. */
  void spread(int z) {
    const semantic_planning::Surface* below = m_ground.near(m_center, z, m_ground.step());
    std::vector<Step> overGround{{m_center, below ? below->z : z}}, overGaps;
    for (std::size_t gap = 0; !overGround.empty() || gap < overGaps.size();) {
      const bool isGap = overGround.empty();
      const Step step = isGap ? overGaps[gap++] : overGround.back();
      if (!isGap) overGround.pop_back();
      int& height = m_heights[m_columns.indexOf(step.column)];
      if (height != kNotReached) continue;
      height = step.z;
      for (const semantic_planning::Column& d : kNeighbors) {
        const semantic_planning::Column c{step.column.x + d.x, step.column.y + d.y};
        if (!contains(c) || m_heights[m_columns.indexOf(c)] != kNotReached) continue;
        const semantic_planning::Surface* s = m_ground.near(c, step.z, m_ground.step());
        (s ? overGround : overGaps).push_back({c, s ? s->z : step.z});
      }
    }
  }

  const semantic_planning::Ground& m_ground;
  const ColumnRectangle m_columns;
  semantic_planning::Column m_center;
  std::vector<int> m_heights;
};

}  // namespace semantic_driving
