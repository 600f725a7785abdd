#include <synthetic_world/Sensors.h>

#include <cmath>
#include <stdexcept>

namespace synthetic_world {

void SensorNoise::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("range_noise", range, "m", strict_files::atLeast(0),
           "standard deviation of ranges and depths");
  list.add("label_noise", label, "", between(0, 1), "share of labels that are of another class");
  list.add("dropout", dropout, "", between(0, 1), "share of rays without a return");
}

void SensorNoise::validate() const { strict_files::checkOptions(*this, "SensorNoise"); }

ClassId SensorNoise::disturbed(ClassId id, Random& random) const {
  if (id == kNoClass || label == 0 || !random.chance(label)) return id;
  const auto other = static_cast<ClassId>(1 + random.below(kClassCount - 1));
  return other < id ? other : static_cast<ClassId>(other + 1);
}

namespace {

constexpr double kFarthest = 250;  // m that the color image reaches
constexpr std::uint64_t kCameraStream = 1;

}  // namespace

double CameraOptions::focalLength() const {
  return width / (2 * std::tan(horizontalFov * M_PI / 360));
}

void CameraOptions::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("width", width, "pixels", between(2, 8192), "of the images");
  list.add("height", height, "pixels", between(2, 8192), "of the images");
  list.add("fov", horizontalFov, "degrees", between(1, 170), "horizontal field of view");
  list.add("max_range", maxRange, "m", strict_files::above(kMinRange).upTo(kFarthest),
           "greatest depth");
}

void CameraOptions::validate() const {
  strict_files::checkOptions(*this, "CameraOptions");
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
      Random random = Random::ofStream(seed.seed, kCameraStream + 4 * seed.frame, pixel);
      const double depth = options.noise.disturbed(hit->range / rangePerDepth, random);
      if (depth < CameraOptions::kMinRange || depth > options.maxRange) continue;
      if (options.noise.drops(random)) continue;
      frame.depth.at(row, column) = static_cast<float>(depth);
      frame.labels.at(row, column) = options.noise.disturbed(hit->material.id, random);
    }
  return frame;
}

}  // namespace synthetic_world
