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

Scene SceneBuilder::finish(Curve route) {
  return {World(std::move(m_terrain), std::move(cover), std::move(m_solids)), std::move(route)};
}

namespace {

constexpr Color kPaints[] = {{168, 34, 38}, {36, 64, 128},   {196, 198, 200}, {40, 42, 46},
                             {92, 98, 104}, {226, 226, 222}, {44, 98, 72},    {188, 152, 62}};
constexpr Color kClothes[] = {{188, 62, 52}, {62, 102, 168},  {222, 196, 72},
                              {92, 142, 92}, {206, 202, 196}, {142, 82, 142}};

}  // namespace

Color SceneBuilder::carColor() { return kPaints[random.below(8)]; }
Color SceneBuilder::clothesColor() { return kClothes[random.below(6)]; }

void SceneBuilder::houses(const Road& road, double left) {
  const double curb = road.halfWidth + road.sidewalk;
  for (double s = 4; s < road.middle.length(); s += 2.0) {
    const double depth = random.uniform(7, 9), width = random.uniform(8.5, 12);
    const Eigen::Vector2d size(width, depth);
    const double front = curb + random.uniform(4.5, 6.5);
    // The door looks to the house's left, the road is on the other side of what is left of it.
    const double yaw = road.middle.heading(s) + (left > 0 ? M_PI : 0);
    const Eigen::Vector2d at = road.middle.beside(s, left * (front + size.y() / 2));
    if (!hasRoom(rectangle(at, yaw, size.x() + 3, size.y() + 3), 2.0)) continue;
    add(house(onGround(at), yaw, size, 1 + random.below(2), random));
    garden(road, s, left, road.middle.beside(s, left * front));
    s += size.x() + 2;
  }
}

void SceneBuilder::garden(const Road& road, double s, double left, const Eigen::Vector2d& door) {
  const double curb = road.halfWidth + road.sidewalk;
  const Eigen::Vector2d gate = road.middle.beside(s, left * (curb - 0.3));
  cover.paintBand(kGravel, gate, door, 1.3);
  if (random.chance(0.5))
    cover.paintBand(kFlowerBed, road.middle.beside(s + 1.4, left * (curb + 2.5)),
                    road.middle.beside(s + 1.4, left * (curb + 4.0)), 1.0);
  const ClassId kinds[] = {kFence, kWall, kBush, kNoClass};
  const ClassId kind = kinds[random.below(4)];
  if (kind == kNoClass) return;
  enclosure(road.middle, s - 7, s - 1.2, left * (curb + 0.7), kind);
  enclosure(road.middle, s + 1.2, s + 7, left * (curb + 0.7), kind);
}

void SceneBuilder::enclosure(const Curve& curve, double from, double to, double left, ClassId id) {
  const int panels = std::max(1, static_cast<int>((to - from) / 1.9));
  const double step = (to - from) / panels;
  for (int i = 0; i < panels; ++i) {
    const Eigen::Vector3d a = onGround(curve.beside(from + i * step, left));
    const Eigen::Vector3d b = onGround(curve.beside(from + (i + 1) * step, left));
    if (!hasRoom(Eigen::Vector2d((a + b).head<2>() / 2), 0.3, 0)) continue;
    add(id == kFence ? fencePanel(a, b) : id == kWall ? wallPanel(a, b, 0.9) : hedgePanel(a, b));
  }
}

void SceneBuilder::parkedCars(const Road& road, double spacing) {
  along(road.middle, spacing, [&](double s) {
    const double left = random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d at = road.middle.beside(s, left * (road.halfWidth - 0.95));
    const double yaw = road.middle.heading(s) + (left > 0 ? M_PI : 0);
    const bool straight = road.middle.curvature(s - 3) == 0 && road.middle.curvature(s + 3) == 0;
    if (!straight) return;
    for (const Solid& other : m_solids)
      if (other.section(other.low(), other.high())->distanceTo(rectangle(at, yaw, 5.5, 1.8)) <= 0)
        return;
    for (const double u : {-4.0, 0.0, 4.0})  // not into a crossing
      if (cover.at(road.middle.beside(s + u, left * (road.halfWidth + 0.3))) != kSidewalk) return;
    add(car(onGround(at), yaw, carColor()));
  });
}

void SceneBuilder::lamps(const Road& road, double spacing) {
  double left = 1;
  along(road.middle, spacing, [&](double s) {
    left = -left;
    const Eigen::Vector2d at = road.middle.beside(s, left * (road.halfWidth + 0.35));
    if (cover.at(at) == road.surface) return;
    const double toRoad = road.middle.heading(s) - left * M_PI / 2;
    add(random.chance(0.7) ? lamp(onGround(at), toRoad)
                           : sign(onGround(at), road.middle.heading(s) + M_PI));
  });
}

void SceneBuilder::people(const Road& road, double spacing) {
  along(road.middle, spacing, [&](double s) {
    const double left = random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d at =
        road.middle.beside(s, left * (road.halfWidth + random.uniform(0.7, 1.4)));
    if (cover.at(at) == road.surface) return;
    const double yaw = road.middle.heading(s) + (random.chance(0.5) ? M_PI : 0);
    add(person(onGround(at), yaw, clothesColor(), 0.3));
  });
}

}  // namespace synthetic_world
