#include "GoalRegion.h"

#include <semantic_driving/ObstacleSensing.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Column;
using semantic_planning::Ground;
using semantic_planning::SemanticPlanner;
using semantic_planning::VehicleOptions;

namespace {

constexpr int kStraight = 5, kDiagonal = 7;  // ways from column to column

double columnsBetween(Column a, Column b) { return std::hypot(a.x - b.x, a.y - b.y); }
int straightWay(Column a, Column b) {
  return static_cast<int>(std::lround(kStraight * columnsBetween(a, b)));
}

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
                       const TPose2D& goal, double aroundGoal)
    : m_square(square),
      m_reached(std::move(reached)),
      m_obstacle(square.size()),
      m_kept(square.size()),
      m_region(square.size()),
      m_unit(planner.ground().voxelSize() / kStraight),
      m_goal(planner.ground().columnAt(goal.x, goal.y)),
      m_left(square.size(), std::numeric_limits<int>::max()) {
  markObstacles(planner, from, z);
  m_enclosed = std::find(m_reached.begin(), m_reached.end(), true) != m_reached.end();
  start(planner.ground(), goal, aroundGoal);
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

void GoalRegion::start(const Ground& ground, const TPose2D& goal, double around) {
  const Column c = ground.columnAt(goal.x, goal.y);
  if (!m_square.contains(c)) return offerRim(c, 0);
  if (!m_kept[m_square.indexOf(c)]) {
    m_goalReached = m_reached[m_square.indexOf(c)];
    if (m_goalReached) m_enclosed = false;
    return offer(c, 0);
  }
  forDisc(c, around / ground.voxelSize(), [&](Column near) { offer(near, straightWay(c, near)); });
}

void GoalRegion::offer(Column c, int left) {
  if (!m_square.contains(c)) return offerRim(c, left);
  const std::size_t i = m_square.indexOf(c);
  if (m_reached[i] && !m_kept[i]) m_enclosed = false;
  if (!isPassable(c) || left >= m_left[i]) return;
  if (!m_region[i]) ++m_columns;
  m_region[i] = true;
  m_left[i] = left;
  m_open[left].push_back(c);
}

/** What lies beyond the square is passable. */
void GoalRegion::offerRim(Column from, int left) {
  if (std::exchange(m_rim, true)) return;
  for (std::size_t i = 0; i < m_square.size(); ++i) {
    const Column c = m_square.columnOf(i);
    if (m_square.isAtRim(c)) offer(c, left + straightWay(from, c));
  }
}

/** Dijkstra's search. */
void GoalRegion::flood() {
  while (!m_open.empty()) {
    const int left = m_open.begin()->first;
    const std::vector<Column> columns = std::move(m_open.begin()->second);
    m_open.erase(m_open.begin());
    for (const Column c : columns) {
      if (m_left[m_square.indexOf(c)] < left) continue;
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (x != 0 || y != 0)
            offer({c.x + x, c.y + y}, left + (x != 0 && y != 0 ? kDiagonal : kStraight));
    }
  }
}

double GoalRegion::wayLeft(Column c) const {
  const int left = m_left[m_square.indexOf(c)];
  return m_unit *
         (left < std::numeric_limits<int>::max() ? left : kStraight * columnsBetween(c, m_goal));
}

}  // namespace semantic_driving
