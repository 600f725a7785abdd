#include "RelaxedField.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ClassPrices.h"

namespace semantic_planning {
namespace {

using Cost = RelaxedField::Cost;

/** Columns of a step that is no longer than what the smallest disc keeps free: where the vehicle
 * fits at both ends, little can be between. */
int strideOf(const CollisionChecker& checker) {
  int needed2 = std::numeric_limits<int>::max();
  for (const auto& disc : checker.discs()) needed2 = std::min(needed2, disc.needed2);
  return std::max(1, static_cast<int>(std::sqrt(needed2)));
}

/** Goes on by several columns where there is room, and by single ones elsewhere: a passage has such
 * columns along its sides, however narrow it is. */
class RelaxedSearch {
 public:
  /** \param stride columns of a step where there is room */
  RelaxedSearch(const CollisionChecker& checker, bool overForbidden, int stride)
      : m_checker(checker),
        m_overForbidden(overForbidden),
        m_stride(stride),
        m_field(checker),
        m_weights(weightsOfRanks(checker.order())) {
    for (std::size_t step = 0; step < kSteps.size(); ++step)
      for (const auto& d : checker.discs())
        m_discs[step].push_back(m_field.turned(d.disc.x, d.disc.y, step));
  }

  /** From one to the other, if there is a way. */
  void run(const GroundPose& start, const GroundPose& goal, RelaxedPath& guide) {
    const Place from = placeAt(start);
    m_goal = placeAt(goal);
    if (!from.surface || !m_goal.surface) return;
    reach(from, {0, {}});
    while (!m_queue.empty()) {
      const auto [estimate, cell] = m_queue.top();
      m_queue.pop();
      if (cell == m_goal.cell) return traceTo(cell, guide);
      const Place place = m_field.placeOf(cell);
      const Cost cost = m_field.label(cell).cost;
      if (estimate != cost + bound(place.column)) continue;  // there was a better way to it
      noteNearest(place.column, guide);
      Slices::count(1);
      const bool singly = isNarrow(*place.surface), isLonger = isOnGrid(place.column);
      for (std::size_t step = 0; step < kSteps.size(); ++step) {
        if (singly) take(step, 1, place, cost);
        if (isLonger) take(step, m_stride, place, cost);
      }
    }
  }

 private:
  using Cell = RelaxedField::Cell;
  using Label = RelaxedField::Label;
  using Place = RelaxedField::Place;

  bool isOnGrid(Column c) const { return c.x % m_stride == 0 && c.y % m_stride == 0; }
  /** Whether something is so near that single columns matter. */
  bool isNarrow(const Surface& s) const {
    const int largest = m_checker.ground().largestClearance();
    return m_stride > 1 && s.clearance2 < largest * largest;
  }

  Place placeAt(const GroundPose& p) const {
    const Column c = m_checker.ground().columnAt(p.pose.x, p.pose.y);
    const Place own = m_field.placeNear(c, p.z, 0);
    if (!own.surface || isNarrow(*own.surface)) return own;
    return m_field.placeNear({c.x - c.x % m_stride, c.y - c.y % m_stride}, p.z,
                             m_stride * m_checker.ground().step());
  }

  /** \param columns that it goes on by \param before what it costs to be there */
  void take(std::size_t step, int columns, const Place& from, Cost before) {
    const Column column{from.column.x + columns * kSteps[step].x,
                        from.column.y + columns * kSteps[step].y};
    const Place to =
        m_field.placeNear(column, from.surface->z, columns * m_checker.ground().step());
    if (!to.surface || !(columns == m_stride || isNarrow(*to.surface) || isOnGrid(column))) return;
    const Label& known = m_field.label(to.cell);
    const Cost length = columns * (step % 2 ? kDiagonalStep : kStraightStep);
    if (before + length * m_weights.front() >= known.cost) return;
    colored_graph::Rank rank = m_field.rankAt(to, step);
    for (int i = 1; i < columns; ++i) rank = std::max(rank, rankAfter(step, i, from));
    if (rank == colored_graph::kForbidden && m_overForbidden) rank = m_checker.order().ranks() - 1;
    if (rank == colored_graph::kForbidden) return;
    const Cost cost = before + length * m_weights[static_cast<std::size_t>(rank)];
    if (cost < known.cost && (to.cell == m_goal.cell || fits(step, to)))
      reach(to, {cost, from.cell});
  }

  /** On the way of a longer step: strips of a class may be narrower. */
  colored_graph::Rank rankAfter(std::size_t step, int columns, const Place& from) const {
    const Place at = m_field.placeNear(
        {from.column.x + columns * kSteps[step].x, from.column.y + columns * kSteps[step].y},
        from.surface->z, columns * m_checker.ground().step());
    return at.surface ? m_field.rankAt(at, step) : 0;
  }
  bool fits(std::size_t step, const Place& at) const {
    for (std::size_t i = 0; i < m_discs[step].size(); ++i) {
      const auto& disc = m_checker.discs()[i];
      const Surface* below =
          m_field.near(at.column + m_discs[step][i], at.surface->z, disc.tolerance);
      if (!below || below->clearance2 < disc.needed2) return false;
    }
    return true;
  }

  void reach(const Place& place, const Label& reached) {
    m_field.label(place.cell) = reached;
    m_queue.emplace(reached.cost + bound(place.column), place.cell);
  }

  Cost bound(Column c) const { return kWeightOfLength * stepsBetween(c, m_goal.column); }

  void noteNearest(Column c, RelaxedPath& guide) {
    const std::int64_t x = c.x - m_goal.column.x, y = c.y - m_goal.column.y;
    if (x * x + y * y >= m_nearest) return;
    m_nearest = x * x + y * y;
    guide.nearest = {m_checker.ground().centerOf(c.x), m_checker.ground().centerOf(c.y)};
  }

  PathPoint pointAt(const Cell& cell) const {
    const Ground& ground = m_checker.ground();
    const Place place = m_field.placeOf(cell);
    PathPoint p;
    p.x = ground.centerOf(place.column.x);
    p.y = ground.centerOf(place.column.y);
    p.z = ground.centerOf(place.surface->z);
    p.classId = place.surface->classId;
    return p;
  }

  void traceTo(Cell cell, RelaxedPath& guide) {
    guide.nearest.reset();
    guide.price = static_cast<double>(m_field.label(cell).cost) / kWeightOfLength / kStraightStep *
                  m_checker.ground().voxelSize();
    for (; cell; cell = m_field.label(cell).before) guide.path.push_back(pointAt(cell));
    std::reverse(guide.path.begin(), guide.path.end());
  }

  const CollisionChecker& m_checker;
  const bool m_overForbidden;
  const int m_stride;
  RelaxedField m_field;
  std::array<std::vector<Column>, kSteps.size()> m_discs;  ///< by step
  const std::vector<Cost> m_weights;                       ///< of a length, by rank
  RelaxedField::Queue m_queue;
  Place m_goal;
  /** Columns from the goal, squared. */
  std::int64_t m_nearest = std::numeric_limits<std::int64_t>::max();
};

}  // namespace

RelaxedField::RelaxedField(const CollisionChecker& checker)
    : m_checker(checker),
      m_surfaces(checker.ground().layers().surfaces()),
      m_tiles(m_surfaces.size()) {
  for (std::size_t i = 0; i < m_tiles.size(); ++i)
    m_tiles[i].surfaces = m_surfaces.at(static_cast<std::int32_t>(i));
  for (std::size_t step = 0; step < kSteps.size(); ++step)
    for (const double y : checker.wheels()) m_wheels[step].push_back(turned(0, y, step));
}

Column RelaxedField::turned(double x, double y, std::size_t step) const {
  const double angle = static_cast<double>(step) * M_PI / 4, voxel = m_checker.ground().voxelSize();
  return {static_cast<int>(std::lround((std::cos(angle) * x - std::sin(angle) * y) / voxel)),
          static_cast<int>(std::lround((std::sin(angle) * x + std::cos(angle) * y) / voxel))};
}

colored_graph::Rank RelaxedField::rankAt(const Place& at, std::size_t step) const {
  colored_graph::Rank worst = 0;
  for (const Column& wheel : m_wheels[step]) {
    const Surface* below = near(at.column + wheel, at.surface->z, 2 * m_checker.ground().step());
    if (!below) return colored_graph::kForbidden;
    worst = std::max(worst, m_checker.order().rank(below->classId));
  }
  return worst;
}

std::vector<std::int64_t> weightsOfRanks(const colored_graph::ClassOrder& order) {
  const ClassPrices prices(order);
  std::vector<Cost> weights;
  for (int rank = 0; rank < order.ranks(); ++rank)
    weights.push_back(std::llround(kWeightOfLength * (1 + prices.rate(rank))));
  return weights;
}

RelaxedPath searchRelaxed(const CollisionChecker& checker, const GroundPose& start,
                          const GroundPose& goal, bool overForbidden) {
  RelaxedPath guide;
  std::vector<PathPoint>& path = guide.path;
  const int stride = strideOf(checker);
  RelaxedSearch(checker, overForbidden, stride).run(start, goal, guide);
  if (path.empty() && stride > 1)  // what classes leave free may be narrower than a step
    RelaxedSearch(checker, overForbidden, 1).run(start, goal, guide);
  if (path.size() < 2) path.clear();
  if (path.empty()) return guide;
  for (std::size_t i = 1; i < path.size(); ++i) {
    PathPoint &a = path[i - 1], &b = path[i];
    b.arcLength = a.arcLength + std::hypot(b.x - a.x, b.y - a.y);
    b.heading = std::atan2(b.y - a.y, b.x - a.x);
  }
  const auto putAt = [](PathPoint& p, const mrpt::math::TPose2D& pose) {
    p.x = pose.x, p.y = pose.y, p.heading = pose.phi;
  };
  putAt(path.front(), start.pose);
  putAt(path.back(), goal.pose);
  return guide;
}

}  // namespace semantic_planning
