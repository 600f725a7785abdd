#include <synthetic_world/World.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace synthetic_world {

SolidIndex::SolidIndex(const Terrain& terrain, const Solids& solids)
    : m_halfExtent(terrain.halfExtent()), m_width(terrain.cells()), m_highest(terrain.highest()) {
  m_cells.reserve(static_cast<std::size_t>(m_width) * m_width);
  for (int cy = 0; cy < m_width; ++cy)
    for (int cx = 0; cx < m_width; ++cx) m_cells.push_back({terrain.cellTop(cx, cy), {}});
  for (std::size_t i = 0; i < solids.size(); ++i) insert(solids[i], static_cast<std::uint32_t>(i));
}

int SolidIndex::cellOf(double coordinate) const {
  const double cell = std::floor((coordinate + m_halfExtent) / Terrain::kCell);
  return static_cast<int>(std::clamp(cell, 0.0, m_width - 1.0));
}

void SolidIndex::insert(const Solid& solid, std::uint32_t number) {
  const Section section = *solid.section(solid.low(), solid.high());
  const Eigen::Vector2d low = solid.center().array() - solid.radius();
  const Eigen::Vector2d high = solid.center().array() + solid.radius();
  for (int cy = cellOf(low.y()); cy <= cellOf(high.y()); ++cy)
    for (int cx = cellOf(low.x()); cx <= cellOf(high.x()); ++cx) {
      const Eigen::Vector2d middle(cx + 0.5 - m_halfExtent, cy + 0.5 - m_halfExtent);
      // A margin, so that rounding in the walk along a ray never steps around a solid.
      if (section.distanceTo(rectangle(middle, 0, 1.001, 1.001)) > 0) continue;
      Cell& cell = m_cells[cy * m_width + cx];
      cell.solids.push_back(number);
      cell.top = std::max(cell.top, solid.high());
    }
  m_highest = std::max(m_highest, solid.high());
}

void Footprint::validate() const {
  requireConvex(outline, "footprint: outline");
  if (!(clearance >= 0))
    throw std::invalid_argument("footprint: clearance is " + std::to_string(clearance) +
                                ", 0 m or more expected");
  if (!(height > clearance))
    throw std::invalid_argument("footprint: height is " + std::to_string(height) +
                                ", more than clearance expected");
}

World::World(Terrain terrain, GroundCover cover, Solids solids)
    : m_terrain(std::move(terrain)),
      m_cover(std::move(cover)),
      m_solids(std::move(solids)),
      m_index(m_terrain, m_solids) {}

Eigen::Isometry3d World::poseOnGround(double x, double y, double yaw) const {
  const Eigen::Vector3d up = m_terrain.normal(x, y);
  // The horizontal heading, tilted onto the slope without turning its compass direction.
  const double c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Vector3d ahead =
      Eigen::Vector3d(c, s, -(up.x() * c + up.y() * s) / up.z()).normalized();
  Eigen::Isometry3d T_world_robot = Eigen::Isometry3d::Identity();
  T_world_robot.linear() << ahead, up.cross(ahead), up;
  T_world_robot.translation() << x, y, groundHeight(x, y);
  return T_world_robot;
}

namespace {

/** Collects the surfaces around a point, given by their signed distances. */
class TruthSearch {
 public:
  explicit TruthSearch(double tolerance) : m_tolerance(tolerance) {}

  /** \param solid Null for the ground. */
  void consider(double signedDistance, const Solid* solid) {
    const double far = std::abs(signedDistance);
    if (signedDistance > m_tolerance) return;
    Candidate& best = far <= m_tolerance ? m_surface : m_deep;
    if (far < best.far) best = {far, solid};
  }

  /** Deep in something hides the surfaces of others: nothing sees them. */
  PointTruth answer(const Eigen::Vector3d& p, ClassId ground) const {
    using State = PointTruth::State;
    const bool deep = m_deep.found();
    const Candidate& best = deep ? m_deep : m_surface;
    if (!best.found()) return {State::Free, kNoClass};
    if (!best.solid) return {deep ? State::Underground : State::Surface, ground};
    return {deep ? State::Inside : State::Surface, best.solid->materialAt(p).id};
  }

 private:
  struct Candidate {
    double far = std::numeric_limits<double>::infinity();
    const Solid* solid = nullptr;
    bool found() const { return std::isfinite(far); }
  };
  double m_tolerance;
  Candidate m_surface, m_deep;
};

}  // namespace

PointTruth World::at(const Eigen::Vector3d& p, double tolerance) const {
  if (!(tolerance >= 0)) throw std::invalid_argument("world: a tolerance of 0 m or more expected");
  TruthSearch search(tolerance);
  for (const Solid& s : m_movables) search.consider(s.signedDistance(p), &s);
  if (m_terrain.contains(p.x(), p.y()))
    search.consider(p.z() - groundHeight(p.x(), p.y()), nullptr);
  for (int cy = m_index.cellOf(p.y() - tolerance); cy <= m_index.cellOf(p.y() + tolerance); ++cy)
    for (int cx = m_index.cellOf(p.x() - tolerance); cx <= m_index.cellOf(p.x() + tolerance); ++cx)
      for (const std::uint32_t i : m_index.solids(cx, cy))
        search.consider(m_solids[i].signedDistance(p), &m_solids[i]);
  return search.answer(p, groundClass(p.x(), p.y()));
}

double World::clearance(const Footprint& footprint, double x, double y, double yaw,
                        double limit) const {
  const Polygon robot = placed(footprint.outline, {x, y}, yaw);
  const double ground = groundHeight(x, y);
  const double low = ground + footprint.clearance, high = ground + footprint.height;
  double least = limit;
  const auto consider = [&](const Solid& s) {
    if (const auto section = s.section(low, high))
      least = std::min(least, section->distanceTo(robot));
  };
  for (const Solid& s : m_movables) consider(s);

  Eigen::Vector2d from = robot.front(), to = robot.front();
  for (const Eigen::Vector2d& v : robot) from = from.cwiseMin(v), to = to.cwiseMax(v);
  for (int cy = m_index.cellOf(from.y() - limit); cy <= m_index.cellOf(to.y() + limit); ++cy)
    for (int cx = m_index.cellOf(from.x() - limit); cx <= m_index.cellOf(to.x() + limit); ++cx)
      for (const std::uint32_t i : m_index.solids(cx, cy)) consider(m_solids[i]);
  return least;
}

}  // namespace synthetic_world
