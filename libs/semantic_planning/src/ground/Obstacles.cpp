#include "Obstacles.h"

#include <algorithm>

namespace semantic_planning {
namespace {

class ObstacleSearch {
 public:
  ObstacleSearch(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape)
      : m_surfaces(surfaces, tile, 1), m_shape(shape) {}

  ObstacleTile in(Column tile) {
    ObstacleTile found;
    forColumnsOf(tile, [&](Column c) {
      const auto begin = static_cast<std::ptrdiff_t>(found.heights.size());
      addOf(c, found.heights);
      std::sort(found.heights.begin() + begin, found.heights.end());
      found.heights.erase(std::unique(found.heights.begin() + begin, found.heights.end()),
                          found.heights.end());
      found.first[indexInTile(c) + 1] = static_cast<std::uint16_t>(found.heights.size());
    });
    found.heights.shrink_to_fit();
    return found;
  }

 private:
  bool isFree(const Surface& s) const { return s.drivable && !m_shape.keepOff[s.classId]; }

  void addOf(Column c, std::vector<std::uint16_t>& heights) const {
    const SurfaceRange own = surfacesAt(m_surfaces, c);
    for (const Surface& s : own)
      if (!isFree(s)) heights.push_back(s.z);
    for (int y = c.y - 1; y <= c.y + 1; ++y)
      for (int x = c.x - 1; x <= c.x + 1; ++x)
        for (const Surface& s : surfacesAt(m_surfaces, {x, y}))
          if (!surfaceNear(own, s.z, m_shape.step) && isFree(s)) heights.push_back(s.z);
  }

  const SurfaceWindow m_surfaces;
  const GroundShape& m_shape;
};

}  // namespace

ObstacleTile obstaclesIn(const SurfaceGrid& surfaces, Column tile, const GroundShape& shape) {
  return ObstacleSearch(surfaces, tile, shape).in(tile);
}

}  // namespace semantic_planning
