#include <synthetic_world/Sensors.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace synthetic_world {
namespace {

constexpr std::uint64_t kLidarStream = 2;

bool isMirror(ClassId id) { return id == kWindow || id == kCar || id == kWater || id == kSign; }

/** What a beam meets by way of the mirror that it hit, with the range of both ways together. Car
 * bodies are round, and windows lean: the mirror's normal is off by some degrees. */
std::optional<Hit> mirrored(const World& world, const Hit& mirror, const Eigen::Vector3d& beam,
                            double maxRange, Random& random) {
  constexpr double kOff = 0.2, kAbove = 1e-3;  // rad, m
  const double z = random.normal(), y = random.normal(), x = random.normal();
  const Eigen::Vector3d off(x, y, z);
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
  list.add("max_range", maxRange, "m", above(kMinRange), "greatest range of returns");
}

void LidarOptions::validate() const {
  strict_files::checkOptions(*this, "LidarOptions");
  strict_files::require(ghosts >= 0 && ghosts <= 1, "LidarOptions::ghosts", ghosts,
                        "a number from 0 to 1");
  strict_files::checkOptions(noise, "SensorNoise");
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
  return scanLidar(
      world, [&](double) { return T_world_lidar; }, options, seed);
}

std::vector<float> sharesOfTurn(const LabeledCloud& scan) {
  std::vector<float> shares;
  for (const Eigen::Vector3f& p : scan.points) {
    const double share = std::atan2(p.y(), p.x()) / (2 * M_PI);
    shares.push_back(static_cast<float>(share < 0 ? share + 1 : share));
  }
  return shares;
}

LabeledCloud scanLidar(const World& world, const LidarPath& path, const LidarOptions& options,
                       FrameSeed seed) {
  options.validate();
  std::vector<Eigen::Isometry3d> poses;  // of columns
  for (int column = 0; column < options.columns; ++column)
    poses.push_back(path(static_cast<double>(column) / options.columns));
  LabeledCloud cloud;
  for (int ring = 0; ring < options.rings; ++ring)
    for (int column = 0; column < options.columns; ++column) {
      const Eigen::Vector3d beam = options.beam(ring, column);
      const Eigen::Isometry3d& T_world_lidar = poses[static_cast<std::size_t>(column)];
      const Eigen::Vector3d direction = T_world_lidar.linear() * beam;
      const double farthest = options.maxRange + 5 * options.noise.range;
      auto hit = world.castRay(T_world_lidar.translation(), direction, farthest);
      if (!hit && options.keepEmpty) {
        cloud.points.push_back((options.maxRange * beam).cast<float>());
        cloud.classes.push_back(kNoClass);
      }
      if (!hit) continue;
      const auto ray = static_cast<std::uint64_t>(ring) * options.columns + column;
      Random random = Random::ofStream(seed.seed, kLidarStream + 4 * seed.frame, ray);
      if (options.ghosts > 0 && isMirror(hit->material.id) && random.chance(options.ghosts))
        hit = mirrored(world, *hit, direction, farthest, random);
      if (!hit) continue;
      const double range = options.noise.disturbed(hit->range, random);
      if (range < LidarOptions::kMinRange || range > options.maxRange) continue;
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

ClassId SensorNoise::disturbed(ClassId id, Random& random) const {
  if (id == kNoClass || label == 0 || !random.chance(label)) return id;
  const auto other = static_cast<ClassId>(1 + random.below(kClassCount - 1));
  return other < id ? other : static_cast<ClassId>(other + 1);
}

namespace {

const Eigen::Vector3d kToSun = Eigen::Vector3d(-0.45, -0.55, 0.75).normalized();
const Eigen::Vector3d kSunLight(1.0, 0.95, 0.86), kSkyLight(0.42, 0.46, 0.54);
const Eigen::Vector3d kHaze(196, 210, 224);
constexpr double kHazeRange = 160;   // m after which haze takes 63 %
constexpr double kShadowRange = 40;  // m

/** Coarse and fine speckle of a surface: its strength, and the size of its grains in meters. */
struct Texture {
  double strength, grain;
};

Texture textureOf(ClassId id) {
  switch (id) {
    case kGrass:
      return {0.22, 0.35};
    case kCanopy:
    case kBush:
      return {0.5, 0.14};
    case kGravel:
      return {0.20, 0.09};
    case kDirt:
      return {0.22, 0.5};
    case kFlowerBed:
      return {0.75, 0.16};
    case kRock:
      return {0.28, 0.2};
    case kTrunk:
      return {0.25, 0.12};
    case kRoad:
      return {0.10, 0.25};
    case kWater:
      return {0.07, 1.2};
    case kRoof:
      return {0.12, 0.3};
    default:
      return {0.07, 0.3};
  }
}

/** In [-1, 1], the same within a lattice point. */
double latticeValue(long x, long y, long z) {
  const auto bits = [](long v) { return static_cast<std::uint64_t>(v); };
  const std::uint64_t h =
      scramble(bits(x) * 0x9E3779B97F4A7C15ull ^ bits(y) * 0xC2B2AE3D27D4EB4Full ^
               bits(z) * 0x165667B19E3779F9ull);
  return static_cast<double>(h >> 11) * 0x1.0p-52 - 1;
}

/** Value noise (Perlin 1985): lattice values interpolated smoothly. */
double noise(const Eigen::Vector3d& p) {
  const Eigen::Vector3d low = p.array().floor(), f = p - low;
  const Eigen::Array3d w = f.array().square() * (3 - 2 * f.array());
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight =
        (i ? w.x() : 1 - w.x()) * (j ? w.y() : 1 - w.y()) * (k ? w.z() : 1 - w.z());
    sum += weight * latticeValue(std::lround(low.x()) + i, std::lround(low.y()) + j,
                                 std::lround(low.z()) + k);
  }
  return sum;
}

/** Lines that people draw: courses of tiles, planks. 1 off a line. */
double pattern(const Hit& hit) {
  const auto line = [](double v, double pitch, double share) {
    return v / pitch - std::floor(v / pitch) < share ? 0.82 : 1.0;
  };
  const Eigen::Vector3d& p = hit.point;
  switch (hit.material.id) {
    case kRoof:
      return line(p.z(), 0.17, 0.2);
    case kFence:
      return line(p.x() + p.y(), 0.21, 0.15);
    case kSidewalk:
      return std::min(line(p.x(), 0.8, 0.04), line(p.y(), 0.8, 0.04));
    case kWall:
      return line(p.z(), 0.25, 0.1);
    default:
      return 1.0;
  }
}

double brightness(const Hit& hit) {
  const Texture t = textureOf(hit.material.id);
  const double fine = noise(hit.point / t.grain), coarse = noise(hit.point / (6 * t.grain));
  return pattern(hit) * std::max(0.2, 1 + t.strength * (0.6 * fine + 0.6 * coarse));
}

bool inShadow(const World& world, const Hit& hit) {
  return world.castRay(hit.point + 0.02 * hit.normal + 0.01 * kToSun, kToSun, kShadowRange)
      .has_value();
}

Eigen::Vector3d vector(Color c) { return Eigen::Vector3d(c.r, c.g, c.b); }

Color color(const Eigen::Vector3d& v) {
  const auto byte = [](double x) {
    return static_cast<std::uint8_t>(std::clamp(x, 0.0, 255.0) + 0.5);
  };
  return {byte(v.x()), byte(v.y()), byte(v.z())};
}

Eigen::Vector3d sky(const Eigen::Vector3d& direction) {
  const double up = std::clamp(direction.z() * 1.6, 0.0, 1.0);
  return kHaze + std::sqrt(up) * (Eigen::Vector3d(112, 158, 214) - kHaze);
}

/** Color of the sky in a direction of unit length. */
Color skyColor(const Eigen::Vector3d& direction) { return color(sky(direction)); }

/** Color of a surface in the afternoon sun: texture, light, cast shadow, haze. */
Color surfaceColor(const World& world, const Hit& hit) {
  const double facing = hit.normal.dot(kToSun);
  const double sun = facing > 0 && !inShadow(world, hit) ? 0.78 * facing : 0;
  const double open = 0.75 + 0.25 * hit.normal.z();
  const Eigen::Vector3d light = open * kSkyLight + sun * kSunLight;
  const Eigen::Vector3d lit = brightness(hit) * vector(hit.material.tint).cwiseProduct(light);
  const double haze = 1 - std::exp(-hit.range / kHazeRange);
  return color(lit + haze * (kHaze - lit));
}

constexpr double kFarthest = 250;  // m that the color image reaches
constexpr std::uint64_t kCameraStream = 1;

}  // namespace

double CameraOptions::focalLength() const {
  return width / (2 * std::tan(horizontalFov * M_PI / 360));
}

void CameraOptions::describe(strict_files::OptionList& list) {
  using strict_files::between;
  list.add("width", width, "pixels", between(2, 8192), "width of the images");
  list.add("height", height, "pixels", between(2, 8192), "height of the images");
  list.add("fov", horizontalFov, "degrees", between(1, 170), "horizontal field of view");
  list.add("max_range", maxRange, "m", strict_files::above(kMinRange).upTo(kFarthest),
           "greatest depth");
}

void CameraOptions::validate() const {
  strict_files::checkOptions(*this, "CameraOptions");
  strict_files::checkOptions(noise, "SensorNoise");
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
      frame.depth.at(row, column) = static_cast<float>(depth);
      frame.labels.at(row, column) = options.noise.disturbed(hit->material.id, random);
    }
  return frame;
}

}  // namespace synthetic_world
