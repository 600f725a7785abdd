#include "PlanningRegion.h"

#include <cmath>

namespace semantic_planning {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

PlanningRegion::PlanningRegion(const TPose2D& start, const TPose2D& goal, double buffer) {
  const double dx = goal.x - start.x, dy = goal.y - start.y;
  const double direction = std::atan2(dy, dx);
  m_length = std::hypot(dx, dy) + 2 * buffer;
  m_width = 2 * buffer;
  const TPoint2D corner =
      TPose2D(start.x, start.y, direction).composePoint(TPoint2D(-buffer, -buffer));
  m_corner = {corner.x, corner.y, direction};
}

bool PlanningRegion::contains(double x, double y, double margin) const {
  const TPoint2D p = m_corner.inverseComposePoint(TPoint2D(x, y));
  return p.x >= -margin && p.x <= m_length + margin && p.y >= -margin && p.y <= m_width + margin;
}

TPoint2D PlanningRegion::at(double u, double v) const {
  return m_corner.composePoint(TPoint2D(u * m_length, v * m_width));
}

}  // namespace semantic_planning
