#include "GroundFlood.h"

#include <semantic_planning/planner/Slices.h>

#include <algorithm>
#include <cmath>

namespace semantic_driving {

using namespace semantic_planning;

ColumnRectangle knownAround(const Ground& ground, Column center, double radius) {
  constexpr double kMargin = 2;  // m, more than the unknown is looked at from where it is seen
  const auto columns = [&](double meters) { return static_cast<int>(meters / ground.voxelSize()); };
  const ColumnRectangle most = ColumnRectangle::around(center, columns(radius));
  const int margin = columns(kMargin);
  Column low = center, high = center;
  for (const Column& tile : ground.tiles()) {
    const Column first = firstColumnOf(tile), last = lastColumnOf(tile);
    low = {std::min(low.x, first.x), std::min(low.y, first.y)};
    high = {std::max(high.x, last.x), std::max(high.y, last.y)};
  }
  return {{std::max(low.x - margin, most.low().x), std::max(low.y - margin, most.low().y)},
          {std::min(high.x + margin, most.high().x), std::min(high.y + margin, most.high().y)}};
}

GroundFlood::GroundFlood(const SemanticPlanner& planner, const mrpt::math::TPose2D& from, int z,
                         double radius)
    : m_planner(planner),
      m_ground(planner.ground()),
      m_center(m_ground.columnAt(from.x, from.y)),
      m_columns(knownAround(m_ground, m_center, radius)),
      m_ahead{std::cos(from.phi), std::sin(from.phi)},
      m_discs(planner.options().vehicle.footprint.coveringDiscs()),
      m_inner(planner.options().vehicle.footprint.inscribedRadius()),
      m_places(m_columns.size()) {
  for (const Disc& d : m_discs) m_outer = std::max(m_outer, std::hypot(d.x, d.y) + d.radius);
  flood(z);
}

std::vector<bool> GroundFlood::reached() const {
  std::vector<bool> reached(m_places.size());
  for (std::size_t i = 0; i < m_places.size(); ++i) reached[i] = m_places[i].done;
  return reached;
}

bool GroundFlood::isNear(Column c, double distance) const {
  const double x = c.x - m_center.x, y = c.y - m_center.y, most = distance / m_ground.voxelSize();
  return x * x + y * y <= most * most;
}

bool GroundFlood::fits(Column c, const Surface& surface, const Column& direction) const {
  if (isFree(surface, m_outer)) return true;
  if (!isFree(surface, m_inner)) return false;
  const double length = lengthOf(direction);
  const double x = direction.x / length, y = direction.y / length;
  return fitsHeaded(c, surface.z, x, y) || fitsHeaded(c, surface.z, -x, -y);
}

/** \param x, y of the heading, whose length is 1 */
bool GroundFlood::fitsHeaded(Column c, int z, double x, double y) const {
  const double originX = m_ground.centerOf(c.x), originY = m_ground.centerOf(c.y);
  return std::all_of(m_discs.begin(), m_discs.end(), [&](const Disc& d) {
    const Column at = m_ground.columnAt(originX + x * d.x - y * d.y, originY + y * d.x + x * d.y);
    const int columns = std::max(std::abs(at.x - c.x), std::abs(at.y - c.y));
    const Surface* s = m_ground.near(at, z, std::max(1, columns) * m_ground.step());
    return s && isFree(*s, d.radius);
  });
}

void GroundFlood::offer(const Place& offered, Column c) {
  const std::size_t i = m_columns.indexOf(c);
  m_places[i] = offered;
  m_open.emplace(offered.cost, i);
}

void GroundFlood::flood(int z) {
  const Surface* s = m_ground.near(m_center, z, 2 * m_ground.step());
  if (s) offer({0, m_center, m_planner.order().rank(s->classId), s->z, false}, m_center);
  while (!m_open.empty()) {
    const std::size_t i = m_open.top().second;
    m_open.pop();
    if (m_places[i].done) continue;
    m_places[i].done = true;
    Slices::count(1);
    expand(m_columns.columnOf(i), m_places[i]);
  }
}

/** What turning adds to a step in direction d to c: who leaves where it does not head, turns. */
double GroundFlood::turningOf(Column c, const Column& d) const {
  constexpr double kWithin = 1;   // m
  constexpr double kTurning = 4;  // m on rank 0, for turning around
  const double voxel = m_ground.voxelSize();
  if (!isNear(c, kWithin)) return 0;
  const double ahead = (d.x * m_ahead.x + d.y * m_ahead.y) / lengthOf(d);
  return kTurning * (1 - ahead) / 2 * lengthOf(d) * voxel / kWithin;
}

void GroundFlood::expand(Column c, const Place& place) {
  constexpr double kLenient = 1.5;  // m around where the vehicle stands there may be less clearance
  for (const Column& d : kNeighbors) {
    const Column next{c.x + d.x, c.y + d.y};
    const double way = lengthOf(d) * m_ground.voxelSize();
    if (!m_columns.contains(next) || place.cost + way >= at(next).cost) continue;
    const Surface* s = m_ground.near(next, place.z, m_ground.step());
    if (!s || !s->drivable) continue;
    const colored_graph::Rank rank = m_planner.order().rank(s->classId);
    if (rank == colored_graph::kForbidden) continue;
    const double cost = place.cost + way * (rank + 1) + turningOf(next, d);
    if (cost < at(next).cost && (fits(next, *s, d) || isNear(next, kLenient)))
      offer({cost, c, rank, s->z, false}, next);
  }
}

}  // namespace semantic_driving
