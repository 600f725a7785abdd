#include <synthetic_world/Objects.h>

namespace synthetic_world {
namespace {

constexpr double kFoundation = 3.0;  // m below the ground: hills may be steep

constexpr Color kPlaster[] = {{226, 214, 190}, {214, 188, 150}, {196, 128, 98}, {206, 206, 200},
                              {228, 206, 150}, {172, 110, 88},  {186, 196, 200}};
constexpr Color kTiles[] = {{150, 72, 54}, {124, 62, 50}, {96, 84, 84}, {166, 92, 64}};

Eigen::Vector2d ahead(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }
Eigen::Vector2d leftOf(double yaw) { return {-std::sin(yaw), std::cos(yaw)}; }

Solid box(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& size, double low,
          double high, Material side, Material top) {
  const Polygon outline = rectangle(center, yaw, size.x(), size.y());
  return {Polyhedron(outline, outline, low, high), side, top};
}

}  // namespace

Solids house(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Random& random) {
  const Material plaster(kBuilding, kPlaster[random.below(7)]);
  const Material tiles(kRoof, kTiles[random.below(4)]), door(kBuilding, {98, 66, 48});
  const Eigen::Vector2d at = base.head<2>();
  const double floor = base.z() + 0.2, eaves = floor + storeys * kStorey;
  Solids result{
      box(at, yaw, size, base.z() - kFoundation, eaves, plaster, tiles).withWindows(floor)};
  result.emplace_back(Polyhedron::gable(at, yaw, size.x() + 0.8, size.y() + 1.0, eaves - 0.05,
                                        eaves + 0.34 * size.y()),
                      tiles);
  const Eigen::Vector2d doorAt = at + leftOf(yaw) * size.y() / 2;
  result.push_back(box(doorAt, yaw, {1.2, 0.16}, base.z() - 1, floor + 2.35, door, door));
  const Eigen::Vector2d chimney =
      at + ahead(yaw) * size.x() * random.uniform(-0.3, 0.3) + leftOf(yaw) * size.y() * 0.2;
  const Material brick(kRoof, {128, 70, 58});
  result.push_back(
      box(chimney, yaw, {0.7, 0.6}, eaves, eaves + 0.34 * size.y() + 0.7, brick, brick));
  return result;
}

Solids block(const Eigen::Vector3d& base, double yaw, const Eigen::Vector2d& size, int storeys,
             Color tint) {
  const Eigen::Vector2d at = base.head<2>();
  const double floor = base.z() + 0.2, top = floor + storeys * kStorey + 0.5;
  const Material wall(kBuilding, tint), gravelRoof(kRoof, {120, 108, 104});
  Solids result{
      box(at, yaw, size, base.z() - kFoundation, top, wall, gravelRoof).withWindows(floor)};
  result.push_back(
      box(at, yaw, {size.x() * 0.3, size.y() * 0.3}, top, top + 1.6, wall, gravelRoof));
  const Material glass(kWindow), canopy(kRoof, {92, 92, 96});
  const Eigen::Vector2d entrance = at + leftOf(yaw) * size.y() / 2;
  result.push_back(box(entrance, yaw, {3.0, 0.3}, base.z() - 1, floor + 2.4, glass, glass));
  result.push_back(box(entrance + leftOf(yaw) * 0.9, yaw, {4.0, 2.0}, floor + 2.6, floor + 2.85,
                       canopy, canopy));
  return result;
}

}  // namespace synthetic_world
