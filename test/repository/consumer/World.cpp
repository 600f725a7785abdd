#include "World.h"

#include <cmath>

namespace world {
namespace {

const Eigen::AlignedBox3d kWallBox(Eigen::Vector3d(12, -2, 0), Eigen::Vector3d(12.4, 2, 2));

/** Where the line from a to b first meets the wall's front or back, or else b. */
Eigen::Vector3d endOfBeam(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double x = a.x() < kWallBox.min().x() ? kWallBox.min().x() : kWallBox.max().x();
  const double t = (x - a.x()) / (b.x() - a.x());
  const Eigen::Vector3d crossing = a + t * (b - a);
  const bool meets = t > 0 && t < 1 && kWallBox.exteriorDistance(crossing) < 1e-9;
  return meets ? crossing : b;
}

}  // namespace

semantic_types::LabeledCloud scanFrom(const Eigen::Isometry3d& T_map_sensor) {
  semantic_types::LabeledCloud cloud;
  const Eigen::Vector3d sensor = T_map_sensor.translation();
  for (double x = -4.9; x < 25; x += 0.15)
    for (double y = -6.9; y < 7; y += 0.15) {
      const Eigen::Vector3d ground(x, y, 0.05), point = endOfBeam(sensor, ground);
      const auto label = point != ground ? kWall : std::fabs(y) < 2.5 ? kRoad : kGrass;
      cloud.points.push_back((T_map_sensor.inverse() * point).cast<float>());
      cloud.classes.push_back(label);
    }
  return cloud;
}

}  // namespace world
