#include "GoalRegion.h"

#include <semantic_driving/ObstacleSensing.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::SemanticPlanner;
using semantic_planning::VehicleOptions;

namespace {

/** f(column) for the columns whose centers are at most `radius` (voxels) away. */
template <class F>
void forDisc(Column center, double radius, F f) {
  const int reach = static_cast<int>(radius);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (std::hypot(x, y) <= radius) f(Column{center.x + x, center.y + y});
}

}  // namespace

GoalRegion::GoalRegion(const SemanticPlanner& planner, const ColumnSquare& square,
                       std::vector<bool> reached, const TPose2D& from, double z,
                       const TPose2D& goal)
    : m_square(square),
      m_reached(std::move(reached)),
      m_obstacle(square.size()),
      m_kept(square.size()),
      m_region(square.size()) {
  markObstacles(planner, from, z);
  m_enclosed = std::find(m_reached.begin(), m_reached.end(), true) != m_reached.end();
  start(planner.ground(), goal);
  flood();
}

void GoalRegion::markObstacles(const SemanticPlanner& planner, const TPose2D& from, double z) {
  const Ground& ground = planner.ground();
  const VehicleOptions& vehicle = planner.options().vehicle;
  const double radius =
      (vehicle.footprint.inscribedRadius() + vehicle.clearance) / ground.voxelSize();
  ObstacleOptions options;
  options.radius = m_square.reach() * ground.voxelSize();
  for (const auto& seen : senseObstacles(planner, from, z, options)) {
    const auto p = from.composePoint({seen.x(), seen.y()});
    const Column c = ground.columnAt(p.x, p.y);
    if (!m_square.contains(c)) continue;
    m_obstacle[m_square.indexOf(c)] = true;
    keepAround(c, radius);
  }
}

/** From anywhere in a column n away the obstacle's nearest side is at most n away. */
void GoalRegion::keepAround(Column obstacle, double radius) {
  constexpr double kLess = 1e-6;  // n itself is far enough
  forDisc(obstacle, std::max(0.0, radius - kLess), [this](Column c) {
    if (m_square.contains(c)) m_kept[m_square.indexOf(c)] = true;
  });
}

void GoalRegion::start(const Ground& ground, const TPose2D& goal) {
  const Column c = ground.columnAt(goal.x, goal.y);
  if (!m_square.contains(c)) return offerRim();
  if (!m_kept[m_square.indexOf(c)]) {
    m_goalReached = m_reached[m_square.indexOf(c)];
    if (m_goalReached) m_enclosed = false;
    return offer(c);
  }
  forDisc(c, kAroundGoal / ground.voxelSize(), [this](Column near) { offer(near); });
}

void GoalRegion::offer(Column c) {
  if (!m_square.contains(c)) return offerRim();
  const std::size_t i = m_square.indexOf(c);
  if (m_reached[i] && !m_kept[i]) m_enclosed = false;
  if (!isPassable(c) || m_region[i]) return;
  m_region[i] = true;
  ++m_columns;
  m_open.push_back(c);
}

/** What lies beyond the square is passable. */
void GoalRegion::offerRim() {
  if (std::exchange(m_rim, true)) return;
  for (std::size_t i = 0; i < m_square.size(); ++i)
    if (m_square.isAtRim(m_square.columnOf(i))) offer(m_square.columnOf(i));
}

void GoalRegion::flood() {
  while (!m_open.empty()) {
    const Column c = m_open.back();
    m_open.pop_back();
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) offer({c.x + x, c.y + y});
  }
}

}  // namespace semantic_driving
