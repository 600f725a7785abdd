#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/ground/Ground.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <vector>

namespace semantic_driving {

/** The columns around a vehicle, each with the height of the ground that leads there. */
class Surroundings {
 public:
  Surroundings(const semantic_planning::Ground& ground, const mrpt::math::TPose2D& pose, int z,
               double radius)
      : m_ground(ground),
        m_center(ground.columnAt(pose.x, pose.y)),
        m_reach(static_cast<int>(std::ceil(radius / ground.voxelSize()))),
        m_edge(2 * m_reach + 1),
        m_heights(static_cast<std::size_t>(m_edge) * m_edge, kNotReached) {
    spread(z);
  }

  bool contains(semantic_planning::Column c) const {
    return std::abs(c.x - m_center.x) <= m_reach && std::abs(c.y - m_center.y) <= m_reach;
  }
  bool isWithinRadius(semantic_planning::Column c) const {
    const int x = c.x - m_center.x, y = c.y - m_center.y;
    return x * x + y * y <= m_reach * m_reach;
  }
  /** Key of the ground's height there, or that leads there. \param c contained */
  int height(semantic_planning::Column c) const { return m_heights[indexOf(c)]; }
  semantic_planning::Column low() const { return {m_center.x - m_reach, m_center.y - m_reach}; }
  semantic_planning::Column high() const { return {m_center.x + m_reach, m_center.y + m_reach}; }

  /** f(column, key of the ground's height, surface there or null) */
  template <class F>
  void forEach(F f) const {
    for (int y = -m_reach; y <= m_reach; ++y)
      for (int x = -m_reach; x <= m_reach; ++x) {
        const semantic_planning::Column c{m_center.x + x, m_center.y + y};
        if (!isWithinRadius(c)) continue;
        const int z = m_heights[indexOf(c)];
        f(c, z, m_ground.near(c, z, m_ground.step()));
      }
  }

 private:
  static constexpr int kNotReached = -1;
  static constexpr std::array<semantic_planning::Column, 4> kNeighbors = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  struct Step {
    semantic_planning::Column column;
    int z;
  };

  std::size_t indexOf(semantic_planning::Column c) const {
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
      const semantic_planning::Surface* here = m_ground.near(step.column, step.z, m_ground.step());
      height = here ? here->z : step.z;
      for (const semantic_planning::Column& d : kNeighbors) {
        const semantic_planning::Column c{step.column.x + d.x, step.column.y + d.y};
        if (!contains(c) || m_heights[indexOf(c)] != kNotReached) continue;
        if (m_ground.near(c, height, m_ground.step()))
          next.push_front({c, height});
        else
          next.push_back({c, height});
      }
    }
  }

  const semantic_planning::Ground& m_ground;
  semantic_planning::Column m_center;
  int m_reach, m_edge;
  std::vector<int> m_heights;
};

}  // namespace semantic_driving
