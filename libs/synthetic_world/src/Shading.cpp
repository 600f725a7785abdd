#include <synthetic_world/Objects.h>
#include <synthetic_world/Sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace synthetic_world {
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

}  // namespace

Color skyColor(const Eigen::Vector3d& direction) { return color(sky(direction)); }

Color surfaceColor(const World& world, const Hit& hit) {
  const double facing = hit.normal.dot(kToSun);
  const double sun = facing > 0 && !inShadow(world, hit) ? 0.78 * facing : 0;
  const double open = 0.75 + 0.25 * hit.normal.z();
  const Eigen::Vector3d light = open * kSkyLight + sun * kSunLight;
  const Eigen::Vector3d lit = brightness(hit) * vector(hit.material.tint).cwiseProduct(light);
  const double haze = 1 - std::exp(-hit.range / kHazeRange);
  return color(lit + haze * (kHaze - lit));
}

TopView renderTopView(const World& world, double metersPerPixel) {
  const double edge = 2 * world.halfExtent(), pixels = std::floor(edge / metersPerPixel);
  if (!(metersPerPixel > 0) || pixels > 8192)
    throw std::invalid_argument("top view: metersPerPixel is " + std::to_string(metersPerPixel) +
                                ", a positive number that leaves 8192 pixels or fewer expected");
  const int size = static_cast<int>(pixels);
  constexpr double kHeight = 60;
  TopView view{Image<Color>(size, size), Image<ClassId>(size, size, kNoClass)};
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double x = (column + 0.5) * metersPerPixel - world.halfExtent();
      const double y = world.halfExtent() - (row + 0.5) * metersPerPixel;
      auto hit = world.castRay({x, y, world.groundHeight(x, y) + kHeight},
                               -Eigen::Vector3d::UnitZ(), 2 * kHeight);
      if (!hit) continue;
      hit->range = 0;  // no haze
      view.color.at(row, column) = surfaceColor(world, *hit);
      view.labels.at(row, column) = hit->material.id;
    }
  return view;
}

}  // namespace synthetic_world
