#include <synthetic_world/Sensors.h>

#include <cmath>

namespace synthetic_world {
namespace {

constexpr std::uint64_t kLidarStream = 2;

bool isMirror(ClassId id) { return id == kWindow || id == kCar || id == kWater || id == kSign; }

/** What a beam meets by way of the mirror that it hit, with the range of both ways together. Car
 * bodies are round, and windows lean: the mirror's normal is off by some degrees. */
std::optional<Hit> mirrored(const World& world, const Hit& mirror, const Eigen::Vector3d& beam,
                            double maxRange, Random& random) {
  constexpr double kOff = 0.2, kAbove = 1e-3;  // rad, m
  const Eigen::Vector3d off(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d normal = (mirror.normal + kOff * off).normalized();
  const Eigen::Vector3d away = beam - 2 * beam.dot(normal) * normal;
  if (away.dot(mirror.normal) <= 0) return std::nullopt;
  auto hit = world.castRay(mirror.point + kAbove * mirror.normal, away, maxRange - mirror.range);
  if (hit) hit->range += mirror.range;
  return hit;
}

}  // namespace

void LidarOptions::describe(strict_files::OptionList& list) {
  using strict_files::above;
  using strict_files::between;
  list.add("rings", rings, "", between(1, 1024), "beams above each other");
  list.add("columns", columns, "", between(1, 16384), "beams beside each other, all around");
  list.add("lowest", lowest, "degrees", above(-90).below(90), "elevation of the lowest ring");
  list.add("highest", highest, "degrees", above(-90).below(90), "elevation of the highest ring");
  list.add("max_range", maxRange, "m", above(kMinRange), "of returns");
}

void LidarOptions::validate() const {
  strict_files::checkOptions(*this, "LidarOptions");
  strict_files::require(ghosts >= 0 && ghosts <= 1, "LidarOptions::ghosts", ghosts,
                        "a number from 0 to 1");
  noise.validate();
  strict_files::require(lowest <= highest, "LidarOptions::lowest", lowest, "at most highest");
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
      const Eigen::Vector3d direction = T_world_lidar.linear() * beam;
      const double farthest = options.maxRange + 5 * options.noise.range;
      auto hit = world.castRay(T_world_lidar.translation(), direction, farthest);
      if (!hit) continue;
      const auto ray = static_cast<std::uint64_t>(ring) * options.columns + column;
      Random random = Random::ofStream(seed.seed, kLidarStream + 4 * seed.frame, ray);
      if (options.ghosts > 0 && isMirror(hit->material.id) && random.chance(options.ghosts))
        hit = mirrored(world, *hit, direction, farthest, random);
      if (!hit) continue;
      const double range = options.noise.disturbed(hit->range, random);
      if (range < LidarOptions::kMinRange || range > options.maxRange) continue;
      if (options.noise.drops(random)) continue;
      cloud.points.push_back((range * beam).cast<float>());
      cloud.classes.push_back(options.noise.disturbed(hit->material.id, random));
    }
  return cloud;
}

void SensorNoise::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("range_noise", range, "m", strict_files::atLeast(0),
           "standard deviation of ranges and depths");
  list.add("label_noise", label, "", between(0, 1), "share of labels that are of another class");
}

void SensorNoise::validate() const {
  strict_files::checkOptions(*this, "SensorNoise");
  strict_files::require(dropout >= 0 && dropout <= 1, "SensorNoise::dropout", dropout,
                        "a number from 0 to 1");
}

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
