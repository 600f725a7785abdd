#include "GroundFlood.h"

#include <algorithm>
#include <cmath>

namespace semantic_driving {

using semantic_planning::Column;
using semantic_planning::Disc;
using semantic_planning::SemanticPlanner;
using semantic_planning::Surface;

GroundFlood::GroundFlood(const SemanticPlanner& planner, const mrpt::math::TPose2D& from, int z,
                         double radius)
    : m_planner(planner),
      m_ground(planner.ground()),
      m_center(m_ground.columnAt(from.x, from.y)),
      m_square(m_center, static_cast<int>(radius / m_ground.voxelSize())),
      m_ahead{std::cos(from.phi), std::sin(from.phi)},
      m_discs(planner.options().vehicle.footprint.coveringDiscs()),
      m_inner(planner.options().vehicle.footprint.inscribedRadius()),
      m_places(m_square.size()) {
  for (const Disc& d : m_discs) m_outer = std::max(m_outer, std::hypot(d.x, d.y) + d.radius);
  flood(z);
}

std::vector<bool> GroundFlood::reached() const {
  std::vector<bool> reached(m_places.size());
  for (std::size_t i = 0; i < m_places.size(); ++i) reached[i] = m_places[i].done;
  return reached;
}

/** Where the vehicle stands there may be less clearance. */
bool GroundFlood::isNear(Column c) const {
  constexpr double kLenient = 1.5;  // m
  return std::hypot(c.x - m_center.x, c.y - m_center.y) < kLenient / m_ground.voxelSize();
}

bool GroundFlood::fits(Column c, const Surface& surface, const Column& direction) const {
  if (isFree(surface, m_outer)) return true;
  if (!isFree(surface, m_inner)) return false;
  const double length = std::hypot(direction.x, direction.y);
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

void GroundFlood::offer(Column c, double cost, int z, Column from) {
  Place& place = m_places[m_square.indexOf(c)];
  if (place.done || cost >= place.cost) return;
  place.cost = cost, place.z = z, place.from = from;
  m_open.emplace(cost, m_square.indexOf(c));
}

void GroundFlood::flood(int z) {
  const Surface* s = m_ground.near(m_center, z, 2 * m_ground.step());
  if (s) offer(m_center, 0, s->z, m_center);
  while (!m_open.empty()) {
    const std::size_t i = m_open.top().second;
    m_open.pop();
    if (m_places[i].done) continue;
    m_places[i].done = true;
    expand(m_square.columnOf(i), m_places[i]);
  }
}

/** What turning adds to a step in direction d to c: who leaves where it does not head, turns. */
double GroundFlood::turningOf(Column c, const Column& d) const {
  constexpr double kWithin = 1;   // m
  constexpr double kTurning = 4;  // m on rank 0, for turning around
  const double voxel = m_ground.voxelSize();
  if (std::hypot(c.x - m_center.x, c.y - m_center.y) * voxel > kWithin) return 0;
  const double ahead = (d.x * m_ahead.x + d.y * m_ahead.y) / std::hypot(d.x, d.y);
  return kTurning * (1 - ahead) / 2 * std::hypot(d.x, d.y) * voxel / kWithin;
}

void GroundFlood::expand(Column c, const Place& place) {
  for (const Column& d : kNeighbors) {
    const Column next{c.x + d.x, c.y + d.y};
    if (!m_square.contains(next) || at(next).done) continue;
    const Surface* s = m_ground.near(next, place.z, m_ground.step());
    if (!s || !s->drivable) continue;
    const colored_graph::Rank rank = m_planner.order().rank(s->classId);
    if (rank == colored_graph::kForbidden || !(fits(next, *s, d) || isNear(next))) continue;
    const double way = std::hypot(d.x, d.y) * m_ground.voxelSize();
    offer(next, place.cost + way * (rank + 1) + turningOf(next, d), s->z, c);
  }
}

}  // namespace semantic_driving
