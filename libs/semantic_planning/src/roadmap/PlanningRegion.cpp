#include "PlanningRegion.h"

#include <algorithm>
#include <cmath>

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

PlanningRegion::PlanningRegion(const TPose2D& start, const TPose2D& goal, double buffer) {
  const double dx = goal.x - start.x, dy = goal.y - start.y, distance = std::hypot(dx, dy);
  m_along = distance > 0 ? TPoint2D(dx / distance, dy / distance) : TPoint2D(1, 0);
  m_length = distance + 2 * buffer;
  m_width = 2 * buffer;
  m_corner = {start.x - buffer * (m_along.x - m_along.y),
              start.y - buffer * (m_along.y + m_along.x)};
}

bool PlanningRegion::contains(double x, double y, double margin) const {
  const double dx = x - m_corner.x, dy = y - m_corner.y;
  const double along = m_along.x * dx + m_along.y * dy, across = m_along.x * dy - m_along.y * dx;
  const bool isWithin = std::isinf(m_length) || (along >= -margin && along <= m_length + margin &&
                                                 across >= -margin && across <= m_width + margin);
  return isWithin &&
         (m_path.empty() || std::any_of(m_path.begin(), m_path.end(), [&](const TPoint2D& p) {
            return std::hypot(p.x - x, p.y - y) <= m_distance + margin;
          }));
}

PlanningRegion PlanningRegion::near(std::vector<TPoint2D> path, double distance) const {
  PlanningRegion region = *this;
  region.m_path = std::move(path);
  region.m_distance = distance;
  return region;
}

TPoint2D PlanningRegion::at(double u, double v) const {
  const double along = u * m_length, across = v * m_width;
  return {m_corner.x + m_along.x * along - m_along.y * across,
          m_corner.y + m_along.y * along + m_along.x * across};
}

std::vector<Column> tilesIn(const PlanningRegion& region, const Ground& ground) {
  const double edge = kTileEdge * ground.voxelSize();
  std::vector<Column> tiles = ground.tiles();
  const auto isOutside = [&](const Column& tile) {
    const Column first = firstColumnOf(tile);
    const double x = ground.centerOf(first.x) + edge / 2, y = ground.centerOf(first.y) + edge / 2;
    return !region.contains(x, y, edge);
  };
  tiles.erase(std::remove_if(tiles.begin(), tiles.end(), isOutside), tiles.end());
  return tiles;
}

}  // namespace semantic_planning
