// What stands along the roads of a scene.
#include <cmath>

#include "SceneBuilder.h"

namespace synthetic_world {
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
    const Eigen::Vector2d size(random.uniform(8.5, 12), random.uniform(7, 9));
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
