#include <synthetic_world/Lidar.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace synthetic_world {
namespace {

constexpr std::uint64_t kStream = 2;

void require(bool ok, const std::string& field, double value, const char* expected) {
  if (!ok)
    throw std::invalid_argument("LiDAR: " + field + " is " + std::to_string(value) + ", " +
                                expected + " expected");
}

}  // namespace

void LidarOptions::validate() const {
  require(rings >= 1 && rings <= 1024, "rings", rings, "1 to 1024");
  require(columns >= 1 && columns <= 16384, "columns", columns, "1 to 16384");
  require(lowest > -90 && lowest <= highest, "lowest", lowest,
          "above -90 degrees, not above highest");
  require(highest < 90, "highest", highest, "below 90 degrees");
  require(minRange >= 0, "minRange", minRange, "0 m or more");
  require(maxRange > minRange && std::isfinite(maxRange), "maxRange", maxRange,
          "more than minRange");
  noise.validate();
}

Eigen::Vector3d LidarOptions::beam(int ring, int column) const {
  const double share = rings > 1 ? static_cast<double>(ring) / (rings - 1) : 0;
  const double elevation = (highest + share * (lowest - highest)) * M_PI / 180;
  const double azimuth = 2 * M_PI * column / columns;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

LabeledCloud scanLidar(const World& world, const Eigen::Isometry3d& T_world_lidar,
                       const LidarOptions& options, FrameSeed seed) {
  options.validate();
  LabeledCloud cloud;
  for (int ring = 0; ring < options.rings; ++ring)
    for (int column = 0; column < options.columns; ++column) {
      const Eigen::Vector3d beam = options.beam(ring, column);
      const auto hit = world.castRay(T_world_lidar.translation(), T_world_lidar.linear() * beam,
                                     options.maxRange + 5 * options.noise.range);
      if (!hit) continue;
      const auto ray = static_cast<std::uint64_t>(ring) * options.columns + column;
      Random random = Random::ofStream(seed.seed, kStream + 4 * seed.frame, ray);
      const double range = options.noise.disturbed(hit->range, random);
      if (range < options.minRange || range > options.maxRange) continue;
      if (options.noise.drops(random)) continue;
      cloud.points.push_back((range * beam).cast<float>());
      cloud.classes.push_back(options.noise.disturbed(hit->material.id, random));
    }
  return cloud;
}

}  // namespace synthetic_world
