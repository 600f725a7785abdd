#include <synthetic_world/Camera.h>
#include <synthetic_world/Shading.h>

#include <cmath>
#include <stdexcept>

namespace synthetic_world {
namespace {

constexpr double kFarthest = 250;  // m that the color image reaches
constexpr std::uint64_t kStream = 1;

void require(bool ok, const std::string& field, double value, const char* expected) {
  if (!ok)
    throw std::invalid_argument("camera: " + field + " is " + std::to_string(value) + ", " +
                                expected + " expected");
}

}  // namespace

double CameraOptions::focalLength() const {
  return width / (2 * std::tan(horizontalFov * M_PI / 360));
}

void CameraOptions::validate() const {
  require(width >= 2 && width <= 8192, "width", width, "2 to 8192 pixels");
  require(height >= 2 && height <= 8192, "height", height, "2 to 8192 pixels");
  require(horizontalFov >= 1 && horizontalFov <= 170, "horizontalFov", horizontalFov,
          "1 to 170 degrees");
  require(minRange >= 0 && std::isfinite(minRange), "minRange", minRange, "0 m or more");
  require(maxRange > minRange && maxRange <= kFarthest, "maxRange", maxRange,
          "more than minRange and at most 250 m");
  noise.validate();
}

CameraFrame renderCamera(const World& world, const Eigen::Isometry3d& T_world_camera,
                         const CameraOptions& options, FrameSeed seed) {
  options.validate();
  const int w = options.width, h = options.height;
  CameraFrame frame{Image<float>(w, h, 0.f), Image<ClassId>(w, h, kNoClass), {}};
  if (options.color) frame.color = Image<Color>(w, h);

  for (int row = 0; row < h; ++row)
    for (int column = 0; column < w; ++column) {
      const Eigen::Vector3d ray = options.ray(row, column);
      const double rangePerDepth = ray.norm();
      const Eigen::Vector3d direction = T_world_camera.linear() * (ray / rangePerDepth);
      const double reach =
          options.color ? kFarthest : (options.maxRange + 5 * options.noise.range) * rangePerDepth;
      const auto hit = world.castRay(T_world_camera.translation(), direction, reach);
      if (options.color)
        frame.color.at(row, column) = hit ? surfaceColor(world, *hit) : skyColor(direction);
      if (!hit) continue;

      const auto pixel = static_cast<std::uint64_t>(row) * w + column;
      Random random = Random::ofStream(seed.seed, kStream + 4 * seed.frame, pixel);
      const double depth = options.noise.disturbed(hit->range / rangePerDepth, random);
      if (depth < options.minRange || depth > options.maxRange) continue;
      if (options.noise.drops(random)) continue;
      frame.depth.at(row, column) = static_cast<float>(depth);
      frame.labels.at(row, column) = options.noise.disturbed(hit->material.id, random);
    }
  return frame;
}

}  // namespace synthetic_world
