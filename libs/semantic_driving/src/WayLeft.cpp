#include "WayLeft.h"

#include <cmath>
#include <limits>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::SemanticPlanner;

WayLeft::WayLeft(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const TPose2D& goal, const FrontierOptions& options)
    : m_planner(planner),
      m_ground(planner.ground()),
      m_flood(flood),
      m_region(region),
      m_square(flood.square()),
      m_unknown(options.unknownFactor),
      m_ways(m_square.size(), std::numeric_limits<double>::infinity()) {
  start(goal, options.aroundGoal);
  search();
}

void WayLeft::start(const TPose2D& goal, double around) {
  const Column c = m_ground.columnAt(goal.x, goal.y);
  if (!m_square.contains(c)) return goAround(goal.x, goal.y, 0);
  const double voxel = m_ground.voxelSize();
  const int reach = m_region.isKept(c) ? static_cast<int>(around / voxel) : 0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (std::hypot(x, y) <= reach)
        offer({c.x + x, c.y + y}, m_unknown * voxel * std::hypot(x, y));
}

/** What lies beyond the square is unknown: from one place at the rim to all others. */
void WayLeft::goAround(double x, double y, double way) {
  if (std::exchange(m_around, true)) return;
  const auto offerAt = [&](const Column& c) {
    offer(c, way + m_unknown * std::hypot(m_ground.centerOf(c.x) - x, m_ground.centerOf(c.y) - y));
  };
  for (std::size_t i = 0; i < m_square.size(); ++i)
    if (m_square.isAtRim(m_square.columnOf(i))) offerAt(m_square.columnOf(i));
}

void WayLeft::offer(Column c, double way) {
  if (!m_square.contains(c)) return;
  const std::size_t i = m_square.indexOf(c);
  if (way >= m_ways[i] || (m_region.isKept(c) && !m_flood.at(c).done)) return;
  m_ways[i] = way;
  m_open.emplace(way, i);
}

/** Of a meter. */
double WayLeft::costOf(Column c) const {
  const GroundFlood::Place& place = m_flood.at(c);
  const auto* surface = place.done ? m_ground.near(c, place.z, 0) : nullptr;
  return surface ? m_planner.order().rank(surface->classId) + 1 : m_unknown;
}

void WayLeft::search() {
  while (!m_open.empty()) {
    const auto [way, i] = m_open.top();
    m_open.pop();
    if (way > m_ways[i]) continue;
    const Column c = m_square.columnOf(i);
    if (m_square.isAtRim(c)) goAround(m_ground.centerOf(c.x), m_ground.centerOf(c.y), way);
    const double meter = costOf(c) * m_ground.voxelSize();
    for (const Column& d : kNeighbors)
      offer({c.x + d.x, c.y + d.y}, way + meter * std::hypot(d.x, d.y));
  }
}

}  // namespace semantic_driving
