#include "GoalRegion.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <limits>

#include "Surroundings.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;

namespace {

/** f(column, distance) for the columns whose centers are at most `radius` (voxels) away. */
template <class F>
void forDisc(Column center, double radius, F f) {
  const int reach = static_cast<int>(radius);
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (const double far = std::hypot(x, y); far <= radius)
        f(Column{center.x + x, center.y + y}, far);
}

}  // namespace

GoalRegion::GoalRegion(const SemanticPlanner& planner, const ColumnRectangle& columns,
                       const std::vector<bool>& reached, const TPose2D& from, double z,
                       const TPose2D& goal)
    : m_columns(columns),
      m_voxel(planner.ground().voxelSize()),
      m_marks(reached.begin(), reached.end()),
      m_ways(columns.size(), std::numeric_limits<double>::infinity()) {
  static_assert(kReached == 1, "as true is");
  m_enclosed = std::count(reached.begin(), reached.end(), true) > 0;
  markObstacles(planner, from, z);
  start(planner.ground(), goal);
  search();
}

/** From anywhere in a column n away the obstacle's nearest side is at most n away. */
void GoalRegion::markObstacles(const SemanticPlanner& planner, const TPose2D& from, double z) {
  constexpr double kLess = 1e-6;  // n itself is far enough
  const Ground& ground = planner.ground();
  const VehicleOptions& vehicle = planner.options().vehicle;
  const double radius = (vehicle.footprint.inscribedRadius() + vehicle.clearance) / m_voxel;
  const ObstacleOptions options;
  const Surroundings heights(ground, m_columns, ground.columnAt(from.x, from.y), ground.keyOf(z));
  Slices::count(m_columns.size() / 10);
  heights.forEach([&](Column c, int height, const Surface* surface) {
    if (c.x == m_columns.low().x) Slices::count(static_cast<std::size_t>(m_columns.width() / 4));
    if (!semantic_driving::isObstacle(planner, options, c, height, surface)) return;
    m_marks[m_columns.indexOf(c)] |= kObstacle;
    forDisc(c, std::max(0.0, radius - kLess), [this](Column near, double) {
      if (m_columns.contains(near)) m_marks[m_columns.indexOf(near)] |= kKept;
    });
  });
}

void GoalRegion::start(const Ground& ground, const TPose2D& goal) {
  const Column c = ground.columnAt(goal.x, goal.y);
  if (!m_columns.contains(c)) return startOutside(ground, goal);
  m_goalReached = is(kReached, c) && !is(kKept, c);
  forDisc(c, is(kKept, c) ? kAroundGoal / m_voxel : 0,
          [this](Column near, double far) { offer(near, far * m_voxel); });
}

/** By steps in eight directions to where the rim is seen from the goal. */
void GoalRegion::startOutside(const Ground& ground, const TPose2D& goal) {
  constexpr double kFar = 1e6;  // m: farther columns have no number
  const Column c =
      ground.columnAt(std::clamp(goal.x, -kFar, kFar), std::clamp(goal.y, -kFar, kFar));
  std::vector<std::pair<double, Column>> seen;
  for (std::size_t i = 0; i < m_columns.size(); ++i) {
    const Column rim = m_columns.columnOf(i);
    if (!m_columns.faces(rim, c)) continue;
    const auto [less, more] = std::minmax(
        {std::abs(ground.centerOf(rim.x) - goal.x), std::abs(ground.centerOf(rim.y) - goal.y)});
    seen.emplace_back(more + (std::sqrt(2.0) - 1) * less, rim);
  }
  m_first = std::min_element(seen.begin(), seen.end())->first;
  for (const auto& [way, rim] : seen) offer(rim, way);
}

void GoalRegion::offer(Column c, double way) {
  if (!m_columns.contains(c)) return;
  const std::size_t i = m_columns.indexOf(c);
  if (way >= m_ways[i]) return;
  const bool isRim = m_columns.isAtRim(c), isReached = m_marks[i] & kReached,
             isKept = m_marks[i] & kKept;
  if (isReached && (isRim || !isKept)) m_enclosed = false;
  if (!isRim && (isReached ? !m_goalReached : isKept)) return;
  m_rim = m_rim || isRim;
  m_size += std::isinf(m_ways[i]);
  m_ways[i] = way;
  const auto bucket = static_cast<std::size_t>(std::max(0.0, way - m_first) / m_voxel);
  if (bucket >= m_open.size()) m_open.resize(bucket + 1);
  m_open[bucket].emplace_back(way, i);
}

/** What is offered meanwhile comes into the same bucket or a later one. */
void GoalRegion::search() {
  for (std::size_t b = 0; b < m_open.size(); ++b) {
    for (std::size_t k = 0; k < m_open[b].size(); ++k) {
      const auto [way, i] = m_open[b][k];
      if (way > m_ways[i]) continue;
      const Column c = m_columns.columnOf(i);
      for (const Column& d : kNeighbors) offer({c.x + d.x, c.y + d.y}, way + lengthOf(d) * m_voxel);
    }
    Slices::count(m_open[b].size() / 4);
  }
}

}  // namespace semantic_driving
