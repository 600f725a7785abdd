#include "WayLeft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::SemanticPlanner;

WayLeft::WayLeft(const SemanticPlanner& planner, const GroundFlood& flood, const GoalRegion& region,
                 const TPose2D& goal, double unknownFactor)
    : m_planner(planner),
      m_ground(planner.ground()),
      m_flood(flood),
      m_region(region),
      m_square(flood.square()),
      m_unknown(unknownFactor),
      m_width(std::max(1.0, m_unknown) * m_ground.voxelSize()),
      m_beyond(std::hypot(1, 1) * kSight * m_unknown),
      m_ways(m_square.size(), std::numeric_limits<double>::infinity()) {
  start(goal);
  search();
}

void WayLeft::start(const TPose2D& goal) {
  const Column c = m_ground.columnAt(goal.x, goal.y);
  if (!m_square.contains(c)) {
    m_first = wayTo(goal);
    return goAround(goal.x, goal.y, 0);
  }
  const double voxel = m_ground.voxelSize();
  const int reach = m_region.isKept(c) ? static_cast<int>(GoalRegion::kAroundGoal / voxel) : 0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (std::hypot(x, y) <= reach)
        offer({c.x + x, c.y + y}, m_unknown * voxel * std::hypot(x, y));
}

/** From the square, at least; weighted meters. */
double WayLeft::wayTo(const TPose2D& goal) const {
  const Column low = m_square.columnOf(0), high = m_square.columnOf(m_square.size() - 1);
  const double x = (m_ground.centerOf(low.x) + m_ground.centerOf(high.x)) / 2;
  const double y = (m_ground.centerOf(low.y) + m_ground.centerOf(high.y)) / 2;
  const double toCorner = std::hypot(m_ground.centerOf(low.x) - x, m_ground.centerOf(low.y) - y);
  return m_unknown * std::max(0.0, std::hypot(goal.x - x, goal.y - y) - toCorner);
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
  if (way >= m_ways[i] || (m_region.isKept(c) && !m_region.isReached(c))) return;
  m_ways[i] = way;
  const auto bucket = static_cast<std::size_t>(std::max(0.0, way - m_first) / m_width);
  if (bucket >= m_open.size()) m_open.resize(bucket + 1);
  m_open[bucket].emplace_back(way, i);
}

/** What a meter costs. */
double WayLeft::costOf(Column c) const {
  const auto* surface = m_region.isReached(c) ? m_ground.near(c, m_flood.at(c).z, 0) : nullptr;
  return surface ? m_planner.order().rank(surface->classId) + 1 : m_unknown;
}

/** What is offered meanwhile comes into the same bucket or a later one. Ends where all that is
 * reached has its way. */
void WayLeft::search() {
  std::size_t left = m_region.numReached();
  std::size_t end = std::numeric_limits<std::size_t>::max();
  for (std::size_t b = 0; b < std::min(end, m_open.size()); ++b) {
    for (std::size_t k = 0; k < m_open[b].size(); ++k) expand(Open(m_open[b][k]));
    if (left == 0) continue;
    left -= reachedIn(m_open[b]);
    if (left == 0) end = b + 2 + static_cast<std::size_t>(m_beyond / m_width);
  }
}

std::size_t WayLeft::reachedIn(const std::vector<Open>& bucket) const {
  return std::count_if(bucket.begin(), bucket.end(), [this](const Open& open) {
    return open.first == m_ways[open.second] && m_region.isReached(m_square.columnOf(open.second));
  });
}

void WayLeft::expand(const Open& open) {
  const auto [way, i] = open;
  if (way > m_ways[i]) return;
  const Column c = m_square.columnOf(i);
  if (m_square.isAtRim(c)) goAround(m_ground.centerOf(c.x), m_ground.centerOf(c.y), way);
  const double straight = costOf(c) * m_ground.voxelSize(), diagonal = straight * std::hypot(1, 1);
  for (const Column& d : kNeighbors)
    offer({c.x + d.x, c.y + d.y}, way + (d.x != 0 && d.y != 0 ? diagonal : straight));
}

}  // namespace semantic_driving
