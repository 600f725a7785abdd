#include "WayLeft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;

WayLeft::WayLeft(const semantic_planning::Ground& ground, const GroundFlood& flood,
                 const GoalRegion& region, const TPose2D& goal, double unknownFactor)
    : m_ground(ground),
      m_flood(flood),
      m_region(region),
      m_columns(flood.columns()),
      m_unknown(unknownFactor),
      m_width(std::max(1.0, m_unknown) * m_ground.voxelSize()),
      m_beyond(std::hypot(1, 1) * kSight * m_unknown),
      m_ways(m_columns.size(), std::numeric_limits<double>::infinity()) {
  start(goal);
  search();
}

void WayLeft::start(const TPose2D& goal) {
  const Column c = m_ground.columnAt(goal.x, goal.y);
  if (!m_columns.contains(c)) return startOutside(goal);
  const double voxel = m_ground.voxelSize();
  const int reach = m_region.isKept(c) ? static_cast<int>(GoalRegion::kAroundGoal / voxel) : 0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (std::hypot(x, y) <= reach)
        offer({c.x + x, c.y + y}, m_unknown * voxel * std::hypot(x, y));
}

/** What lies beyond the rectangle is unknown: by steps in eight directions to where the rim is seen
 * from the goal, and on along the rim. */
void WayLeft::startOutside(const TPose2D& goal) {
  constexpr double kFar = 1e6;  // m: farther columns have no number
  const Column c =
      m_ground.columnAt(std::clamp(goal.x, -kFar, kFar), std::clamp(goal.y, -kFar, kFar));
  std::vector<std::pair<double, Column>> seen;
  m_columns.forRim([&](Column rim) {
    if (!m_columns.faces(rim, c)) return;
    const auto [less, more] = std::minmax(
        {std::abs(m_ground.centerOf(rim.x) - goal.x), std::abs(m_ground.centerOf(rim.y) - goal.y)});
    seen.emplace_back(m_unknown * (more + (std::sqrt(2.0) - 1) * less), rim);
  });
  m_first = std::min_element(seen.begin(), seen.end())->first;
  for (const auto& [way, rim] : seen) offer(rim, way);
}

void WayLeft::offer(Column c, double way) {
  if (!m_columns.contains(c)) return;
  const std::size_t i = m_columns.indexOf(c);
  if (way >= m_ways[i]) return;
  if (m_region.isKept(c) && !m_region.isReached(c) && !m_columns.isAtRim(c)) return;
  m_ways[i] = way;
  const auto bucket = static_cast<std::size_t>(std::max(0.0, way - m_first) / m_width);
  if (bucket >= m_open.size()) m_open.resize(bucket + 1);
  m_open[bucket].emplace_back(way, i);
}

/** What a meter costs. */
double WayLeft::costOf(Column c) const {
  return m_region.isReached(c) ? m_flood.at(c).rank + 1 : m_unknown;
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
    return open.first == m_ways[open.second] && m_region.isReached(m_columns.columnOf(open.second));
  });
}

void WayLeft::expand(const Open& open) {
  const auto [way, i] = open;
  if (way > m_ways[i]) return;
  const Column c = m_columns.columnOf(i);
  const double meter = costOf(c) * m_ground.voxelSize();
  for (const Column& d : kNeighbors) offer({c.x + d.x, c.y + d.y}, way + meter * lengthOf(d));
}

}  // namespace semantic_driving
