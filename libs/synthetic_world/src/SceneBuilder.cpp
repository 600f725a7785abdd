#include "SceneBuilder.h"

#include <algorithm>
#include <cmath>

namespace synthetic_world {
namespace {

std::vector<Terrain::Wave> scaled(std::vector<Terrain::Wave> waves, double hills) {
  for (Terrain::Wave& w : waves) w.amplitude *= hills;
  return waves;
}

Polygon octagon(const Eigen::Vector2d& center, double radius) {
  Polygon result;
  for (int i = 0; i < 8; ++i)
    result.push_back(center +
                     radius * Eigen::Vector2d(std::cos(i * M_PI / 4), std::sin(i * M_PI / 4)));
  return result;
}

/** Is p within `margin` of the surface of another road? */
bool onOtherRoad(const std::vector<Road>& roads, const Road& own, const Eigen::Vector2d& p,
                 double margin) {
  for (const Road& r : roads) {
    if (&r == &own) continue;
    for (double s = 0; s <= r.middle.length(); s += 0.5)
      if ((r.middle.at(s) - p).norm() < r.halfWidth + margin) return true;
  }
  return false;
}

}  // namespace

SceneBuilder::SceneBuilder(int halfExtent, std::vector<Terrain::Wave> waves, double hills,
                           std::uint64_t seed)
    : random(seed),
      cover(halfExtent, kGrass),
      m_terrain(halfExtent, scaled(std::move(waves), hills)) {}

Eigen::Vector3d SceneBuilder::onGround(const Eigen::Vector2d& p) const {
  return {p.x(), p.y(), m_terrain.height(p.x(), p.y())};
}

void SceneBuilder::add(const Solids& solids) {
  m_solids.insert(m_solids.end(), solids.begin(), solids.end());
}

bool SceneBuilder::hasRoom(const Polygon& polygon, double margin) const {
  constexpr int kSteps = 8;
  const Eigen::Vector2d& a = polygon[0];
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j) {
        const Eigen::Vector2d p =
            a + (polygon[k] - a) * i / kSteps + (polygon[k + 1] - a) * j / kSteps;
        if (!m_terrain.contains(p.x(), p.y()) || cover.at(p) != kGrass) return false;
      }
  return std::all_of(m_solids.begin(), m_solids.end(), [&](const Solid& s) {
    return s.section(s.low(), s.high())->distanceTo(polygon) >= margin;
  });
}

bool SceneBuilder::hasRoom(const Eigen::Vector2d& center, double radius, double margin) const {
  return hasRoom(octagon(center, radius), margin);
}

void SceneBuilder::roads(const std::vector<Road>& roads) {
  for (const Road& r : roads)
    if (r.sidewalk > 0) cover.paintCurve(kSidewalk, r.middle, r.halfWidth + r.sidewalk);
  for (auto r = roads.rbegin(); r != roads.rend(); ++r)
    cover.paintCurve(r->surface, r->middle, r->halfWidth);
  constexpr double kDash = 2.0, kPeriod = 5.0;
  for (const Road& r : roads)
    for (double s = 0; r.laneMarks && s + kDash < r.middle.length(); s += kPeriod)
      if (!onOtherRoad(roads, r, r.middle.at(s + kDash / 2), 1.5))
        cover.paintStroke(kLaneMarking, r.middle.at(s), r.middle.at(s + kDash), 0.09);
}

void SceneBuilder::zebra(const Road& road, double s) {
  for (double across = 0.4 - road.halfWidth; across < road.halfWidth - 0.3; across += 1.0)
    cover.paintBand(kLaneMarking, road.middle.beside(s - 1.4, across),
                    road.middle.beside(s + 1.4, across), 0.5);
}

void SceneBuilder::along(const Curve& curve, double spacing, const std::function<void(double)>& f) {
  for (double s = spacing / 2; s < curve.length(); s += spacing * random.uniform(0.75, 1.25)) f(s);
}

void SceneBuilder::scatter(int count, const Region& region, double radius, double margin,
                           const std::function<void(const Eigen::Vector3d&)>& f) {
  for (int tries = 20 * count; count > 0 && tries > 0; --tries) {
    const double x = random.uniform(region.low.x(), region.high.x());
    const double y = random.uniform(region.low.y(), region.high.y());
    if (!hasRoom(Eigen::Vector2d(x, y), radius, margin)) continue;
    f(onGround({x, y}));
    --count;
  }
}

void SceneBuilder::trees(int count, const Region& region, double coniferShare) {
  scatter(count, region, 1.2, 0.4, [&](const Eigen::Vector3d& base) {
    add(random.chance(coniferShare) ? conifer(base, random) : broadleafTree(base, random));
  });
}

void SceneBuilder::bushes(int count, const Region& region) {
  scatter(count, region, 0.9, 0.1, [&](const Eigen::Vector3d& base) { add(bush(base, random)); });
}

Scene SceneBuilder::finish(const std::string& name, std::uint64_t seed, Curve route) {
  return {name, seed, World(std::move(m_terrain), std::move(cover), std::move(m_solids)),
          std::move(route)};
}

}  // namespace synthetic_world
