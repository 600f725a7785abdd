#include "StartGround.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "vehicle/CurveWalk.h"

namespace semantic_planning {
namespace {

/** A surface near a vehicle, in its frame. */
struct Sample {
  double x, y, z;  ///< meters; z in the map's frame
  ClassId classId;
};

/** The nearest ground outside a circle around the footprint, in all directions. */
std::vector<Sample> groundAround(const Ground& ground, const colored_graph::ClassOrder& order,
                                 const Placement& placed, const Eigen::Vector2d& center,
                                 double radius) {
  constexpr int kDirections = 64;
  constexpr double kFar = 10;  // m: what is farther tells little
  std::vector<Sample> samples;
  for (int i = 0; i < kDirections; ++i) {
    const double to = i * 2 * M_PI / kDirections;
    for (double r = radius; r < kFar; r += ground.voxelSize() / 2) {
      const double x = center.x() + r * std::cos(to), y = center.y() + r * std::sin(to);
      const auto [px, py] = placed(x, y);
      const SurfaceRange surfaces = ground.surfaces(ground.columnAt(px, py));
      if (surfaces.empty()) continue;
      const Surface& s = *surfaces.first;
      if (order.rank(s.classId) != colored_graph::kForbidden)
        samples.push_back({x, y, ground.centerOf(s.z), s.classId});
      break;
    }
  }
  return samples;
}

/** Without what is higher or lower than a vehicle on the ground would see: cars' roofs, ghosts. */
void keepLevel(std::vector<Sample>& samples, const VehicleOptions& vehicle,
               std::optional<double> z) {
  if (samples.empty()) return;
  std::vector<double> heights;
  for (const Sample& s : samples) heights.push_back(s.z);
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  const double level = z.value_or(*middle), rise = std::tan(vehicle.maxSlope * M_PI / 180);
  const auto isOff = [&](const Sample& s) {
    return std::abs(s.z - level) > vehicle.stepHeight + rise * std::hypot(s.x, s.y) / 2;
  };
  samples.erase(std::remove_if(samples.begin(), samples.end(), isOff), samples.end());
}

bool areAllAround(const std::vector<Sample>& samples, const Eigen::Vector2d& center) {
  std::array<bool, 4> quadrants{};
  for (const Sample& s : samples)
    quadrants[(s.x > center.x() ? 1 : 0) + (s.y > center.y() ? 2 : 0)] = true;
  return std::count(quadrants.begin(), quadrants.end(), true) == 4;
}

/** Coefficients of the plane z = p0 + p1 x + p2 y of least squares. */
Eigen::Vector3d planeThrough(const std::vector<Sample>& samples) {
  Eigen::MatrixX3d A(samples.size(), 3);
  Eigen::VectorXd b(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    A.row(Eigen::Index(i)) << 1, samples[i].x, samples[i].y;
    b[Eigen::Index(i)] = samples[i].z;
  }
  return A.colPivHouseholderQr().solve(b);
}

ClassId mostFrequentClass(const std::vector<Sample>& samples) {
  std::map<ClassId, int> counts;
  for (const Sample& s : samples) ++counts[s.classId];
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& l, const auto& r) { return l.second < r.second; })
      ->first;
}

}  // namespace

std::vector<GroundPoint> groundBelow(const Ground& ground, const VehicleOptions& vehicle,
                                     const colored_graph::ClassOrder& order,
                                     const mrpt::math::TPose2D& pose, std::optional<double> z) {
  const Placement placed(pose);
  Eigen::AlignedBox2d box;
  for (const Disc& d : vehicle.footprint.coveringDiscs()) {
    const double room = d.radius + vehicle.clearance + 2 * ground.voxelSize();
    box.extend(Eigen::Vector2d(d.x - room, d.y - room));
    box.extend(Eigen::Vector2d(d.x + room, d.y + room));
  }
  std::vector<Sample> samples =
      groundAround(ground, order, placed, box.center(), box.diagonal().norm() / 2);
  keepLevel(samples, vehicle, z);
  if (!areAllAround(samples, box.center())) return {};
  const Eigen::Vector3d plane = planeThrough(samples);
  Surface surface;
  surface.classId = mostFrequentClass(samples);
  surface.filled = true;
  std::map<Column, Surface> below;
  const double step = ground.voxelSize() / 2;
  for (double x = box.min().x(); x <= box.max().x(); x += step)
    for (double y = box.min().y(); y <= box.max().y(); y += step) {
      const auto [px, py] = placed(x, y);
      const Column c = ground.columnAt(px, py);
      if (!ground.surfaces(c).empty()) continue;
      surface.z = static_cast<std::uint16_t>(ground.keyOf(plane.dot(Eigen::Vector3d(1, x, y))));
      below.emplace(c, surface);
    }
  std::vector<GroundPoint> points;
  for (const auto& [column, s] : below) points.push_back({column, s});
  return points;
}

}  // namespace semantic_planning
