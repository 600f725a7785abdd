#include "GroundAround.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "GroundTiles.h"
#include "vehicle/CurveWalk.h"

namespace semantic_planning {

namespace {

/** Ground near a vehicle. */
struct GroundSample {
  double x, y;  ///< in the vehicle's frame, meters
  double z;     ///< meters
  ClassId classId;
};

/** The footprint and the clearance around it, with some room, in the vehicle's frame. */
Eigen::AlignedBox2d boxAround(const VehicleOptions& vehicle, double voxelSize) {
  Eigen::AlignedBox2d box;
  for (const Disc& d : vehicle.footprint.coveringDiscs()) {
    const double room = d.radius + vehicle.clearance + 2 * voxelSize;
    box.extend(Eigen::Vector2d(d.x - room, d.y - room));
    box.extend(Eigen::Vector2d(d.x + room, d.y + room));
  }
  return box;
}

/** f(number of the ray, place in the vehicle's frame, column) along rays from a circle around a box
 * on, in all directions, as long as f says so. */
template <class F>
void forRaysAround(const Ground& ground, const Eigen::AlignedBox2d& box, const Placement& placed,
                   F f) {
  constexpr int kRays = 64;
  constexpr double kFar = 10;  // m: what is farther tells little
  for (int i = 0; i < kRays; ++i) {
    const double to = i * 2 * M_PI / kRays;
    bool goesOn = true;
    for (double r = box.diagonal().norm() / 2; goesOn && r < kFar; r += ground.voxelSize() / 2) {
      const double x = box.center().x() + r * std::cos(to), y = box.center().y() + r * std::sin(to);
      const auto [px, py] = placed(x, y);
      goesOn = f(i, Eigen::Vector2d(x, y), ground.columnAt(px, py));
    }
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double medianHeight(const std::vector<GroundSample>& samples) {
  std::vector<double> heights;
  for (const GroundSample& s : samples) heights.push_back(s.z);
  return median(std::move(heights));
}

/** Leaves out what is higher or lower than a vehicle on the ground would see: cars' roofs, ghosts.
 * \param z of the ground below the vehicle; none: the samples' median */
void keepLevel(std::vector<GroundSample>& samples, const VehicleOptions& vehicle,
               std::optional<double> z) {
  if (samples.empty()) return;
  const double level = z ? *z : medianHeight(samples);
  const double rise = std::tan(vehicle.maxSlope * M_PI / 180);
  const auto isOff = [&](const GroundSample& s) {
    return std::abs(s.z - level) > vehicle.stepHeight + rise * std::hypot(s.x, s.y) / 2;
  };
  samples.erase(std::remove_if(samples.begin(), samples.end(), isOff), samples.end());
}

bool areAllAround(const std::vector<GroundSample>& samples, const Eigen::Vector2d& center) {
  std::array<bool, 4> quadrants{};
  for (const GroundSample& s : samples)
    quadrants[(s.x > center.x() ? 1 : 0) + (s.y > center.y() ? 2 : 0)] = true;
  return std::count(quadrants.begin(), quadrants.end(), true) == 4;
}

/** Coefficients of the plane z = p0 + p1 x + p2 y of least squares. */
Eigen::Vector3d planeThrough(const std::vector<GroundSample>& samples) {
  Eigen::MatrixX3d A(samples.size(), 3);
  Eigen::VectorXd b(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    A.row(Eigen::Index(i)) << 1, samples[i].x, samples[i].y;
    b[Eigen::Index(i)] = samples[i].z;
  }
  return A.colPivHouseholderQr().solve(b);
}

/** The nearest ground in all directions, where the order allows it: z in the map's frame. */
std::vector<GroundSample> groundAround(const Ground& ground, const Eigen::AlignedBox2d& box,
                                       const Placement& placed) {
  std::vector<GroundSample> samples;
  forRaysAround(ground, box, placed, [&](int, const Eigen::Vector2d& at, Column c) {
    const SurfaceRange surfaces = ground.surfaces(c);
    if (surfaces.empty()) return true;
    const Surface& s = *surfaces.first;
    if (ground.layers().shape().ranks[s.classId] != colored_graph::kForbidden)
      samples.push_back({at.x(), at.y(), ground.centerOf(s.z), s.classId});
    return false;
  });
  return samples;
}

ClassId mostFrequentClass(const std::vector<GroundSample>& samples) {
  std::map<ClassId, int> counts;
  for (const GroundSample& s : samples) ++counts[s.classId];
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& l, const auto& r) { return l.second < r.second; })
      ->first;
}

}  // namespace

std::vector<GroundPoint> groundBelow(const Ground& ground, const VehicleOptions& vehicle,
                                     const mrpt::math::TPose2D& pose, std::optional<double> z) {
  const Placement placed(pose);
  const Eigen::AlignedBox2d box = boxAround(vehicle, ground.voxelSize());
  std::vector<GroundSample> samples = groundAround(ground, box, placed);
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

namespace {

using Samples = std::vector<GroundSample>;

/** Height of a robot above ground that was seen around it, or on one side only: there it is as high
 * as below. \param samples z in the robot's frame */
double heightOver(Samples samples, const VehicleOptions& vehicle, const Eigen::Vector2d& center) {
  keepLevel(samples, vehicle, {});
  return areAllAround(samples, center) ? -planeThrough(samples)[0] : -medianHeight(samples);
}

/** Ground that the wheels connect. */
struct Connected {
  Samples nearest;        ///< where rays meet it first; z in the robot's frame
  std::size_t cells = 0;  ///< of rays that it takes
  int lastRay = -1;
};

/** What may be driven upon around a robot and is not above its frame. */
std::map<std::size_t, Connected> connectedAround(const Ground& ground,
                                                 const Eigen::AlignedBox2d& box,
                                                 const Eigen::Isometry3d& T_map_robot) {
  const Eigen::Vector3d p = T_map_robot.translation();
  const Placement placed({p.x(), p.y(), std::atan2(T_map_robot(1, 0), T_map_robot(0, 0))});
  const Eigen::Isometry3d T_robot_map = T_map_robot.inverse();
  const int highest = ground.keyOf(p.z()) + ground.step();
  const GroundTiles& layers = ground.layers();
  std::map<std::size_t, Connected> grounds;
  forRaysAround(ground, box, placed, [&](int ray, const Eigen::Vector2d& at, Column c) {
    for (const Surface& s : ground.surfaces(c)) {
      const bool isForbidden = layers.shape().ranks[s.classId] == colored_graph::kForbidden;
      if (s.filled || !s.drivable || isForbidden || s.z > highest) continue;
      Connected& met = grounds[layers.components().componentOf(c, s)];
      ++met.cells;
      if (std::exchange(met.lastRay, ray) == ray) continue;
      const Eigen::Vector3d center(ground.centerOf(c.x), ground.centerOf(c.y),
                                   ground.centerOf(s.z));
      met.nearest.push_back({at.x(), at.y(), (T_robot_map * center).z(), s.classId});
    }
    return true;
  });
  return grounds;
}

/** The storey that the robot is on: the highest ground of at least half the largest one's size. On
 * a level with the frame's origin a quarter is enough, for most robots have it there. None: too
 * little is seen. */
std::optional<double> heightAbove(const Ground& ground, const VehicleOptions& vehicle,
                                  const Eigen::Isometry3d& T_map_robot) {
  constexpr std::size_t kFew = 4;  // rays
  constexpr double kNone = 0.75;   // voxels: half of one is what heights in the map are off
  const Eigen::AlignedBox2d box = boxAround(vehicle, ground.voxelSize());
  const auto grounds = connectedAround(ground, box, T_map_robot);
  std::size_t most = 0;
  for (const auto& [component, met] : grounds) most = std::max(most, met.cells);
  std::optional<double> height;
  for (const auto& [component, met] : grounds) {
    if (met.nearest.size() < kFew || 4 * met.cells < most) continue;
    const double h = heightOver(met.nearest, vehicle, box.center());
    if (std::abs(h) < kNone * ground.voxelSize()) return 0;
    if (2 * met.cells >= most) height = std::max(0.0, std::min(h, height.value_or(h)));
  }
  return height;
}

}  // namespace

void FrameHeight::look(const Ground& ground, const VehicleOptions& vehicle,
                       const Eigen::Isometry3d& T_map_robot) {
  constexpr std::size_t kSure = 30;
  const Eigen::Vector3d at = T_map_robot.translation();
  const bool isNew = m_heights.empty() || (at - m_lookedAt).norm() > ground.voxelSize();
  if (m_heights.size() == kSure || !isNew) return;
  const auto height = heightAbove(ground, vehicle, T_map_robot);
  if (!height) return;
  m_heights.push_back(*height);
  m_lookedAt = at;
}

std::optional<double> FrameHeight::meters() const {
  if (m_heights.empty()) return std::nullopt;
  return median(m_heights);
}

}  // namespace semantic_planning
