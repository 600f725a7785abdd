#include "GoalRegion.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "Surroundings.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using namespace semantic_planning;

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

GoalRegion::GoalRegion(const SemanticPlanner& planner, const ColumnRectangle& columns,
                       const std::vector<bool>& reached, const TPose2D& from, double z,
                       const TPose2D& goal)
    : m_columns(columns), m_marks(reached.begin(), reached.end()) {
  static_assert(kReached == 1, "as true is");
  m_enclosed = std::count(reached.begin(), reached.end(), true) > 0;
  markObstacles(planner, from, z);
  start(planner.ground(), goal);
  flood();
}

void GoalRegion::markObstacles(const SemanticPlanner& planner, const TPose2D& from, double z) {
  const Ground& ground = planner.ground();
  const VehicleOptions& vehicle = planner.options().vehicle;
  const double radius =
      (vehicle.footprint.inscribedRadius() + vehicle.clearance) / ground.voxelSize();
  const ObstacleOptions options;
  const ObstacleFinder finder(planner, options);
  const Surroundings heights(ground, m_columns, ground.columnAt(from.x, from.y), ground.keyOf(z));
  Slices::count(m_columns.size() / 10);
  heights.forEach([&](Column c, int height, const semantic_planning::Surface* surface) {
    if (finder.isObstacle(c, height, surface)) {
      m_marks[m_columns.indexOf(c)] |= kObstacle;
      keepAround(c, radius);
    }
    if (c.x == m_columns.low().x) Slices::count(static_cast<std::size_t>(m_columns.width() / 4));
  });
}

/** From anywhere in a column n away the obstacle's nearest side is at most n away. */
void GoalRegion::keepAround(Column obstacle, double radius) {
  constexpr double kLess = 1e-6;  // n itself is far enough
  forDisc(obstacle, std::max(0.0, radius - kLess), [this](Column c) {
    if (m_columns.contains(c)) m_marks[m_columns.indexOf(c)] |= kKept;
  });
}

void GoalRegion::start(const Ground& ground, const TPose2D& goal) {
  const Column c = ground.columnAt(goal.x, goal.y);
  if (!m_columns.contains(c)) return offerRim();
  if (!isKept(c)) {
    m_goalReached = isReached(c);
    if (m_goalReached) m_enclosed = false;
    return offer(c);
  }
  forDisc(c, kAroundGoal / ground.voxelSize(), [this](Column near) { offer(near); });
}

void GoalRegion::offer(Column c) {
  if (!m_columns.contains(c)) return offerRim();
  std::uint8_t& marks = m_marks[m_columns.indexOf(c)];
  if ((marks & kReached) && !(marks & kKept)) m_enclosed = false;
  if (marks & (kReached | kKept | kRegion)) return;
  marks |= kRegion;
  ++m_size;
  m_open.push_back(c);
}

/** What lies beyond the rectangle is passable. */
void GoalRegion::offerRim() {
  if (std::exchange(m_rim, true)) return;
  m_columns.forRim([this](Column c) { offer(c); });
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
