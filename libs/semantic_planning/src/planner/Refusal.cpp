#include "Refusal.h"

#include <strict_files/TextFile.h>
#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "ground/GroundTiles.h"
#include "vehicle/CurveWalk.h"

namespace semantic_planning {
namespace {

using Obstacle = ClearanceMeter::Obstacle;

std::string named(const Ground& ground, ClassId id) {
  return id == semantic_types::kNoClass ? "no class" : ground.map().classes().name(id);
}

std::string forbidden(const Ground& ground, ClassId id) {
  return "ground of " + named(ground, id) + ", which the order forbids";
}

/** What stands in the way. A class that the vehicle may drive on does not stand up: the label was
 * wrong, or somebody who passed has left it in the map. \param voxels above the ground */
std::string standing(const CollisionChecker& checker, ClassId id, int voxels) {
  const std::string name = named(checker.ground(), id);
  if (id == semantic_types::kNoClass || checker.order().rank(id) == colored_graph::kForbidden)
    return "an obstacle (" + name + ")";
  std::ostringstream text;
  const strict_files::ClassicNumbers classic(text);
  text << "something " << std::fixed << std::setprecision(1)
       << std::max(1, voxels) * checker.ground().voxelSize() << " m high, labeled " << name
       << ": a wrong label, or what somebody left who passed";
  return text.str();
}

/** A surface at this height, in a column or one next to it; or null. */
const Surface* surfaceAround(const Ground& ground, Column c, int z) {
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (const Surface* s = ground.near({x, y}, z, 0)) return s;
  return nullptr;
}

/** \param z of the ground that the vehicle stands upon */
std::string whatIsAt(const CollisionChecker& checker, const Obstacle& obstacle, int z) {
  const Ground& ground = checker.ground();
  const int step = ground.step();
  if (obstacle.z > z + step)
    if (const Surface* s = surfaceAround(ground, obstacle.column, obstacle.z))
      return standing(checker, s->classId, s->z - z);
  if (const Surface* s = ground.near(obstacle.column, obstacle.z, step))
    return s->drivable ? forbidden(ground, s->classId) : "ground too steep";
  const ColumnTile tile =
      semantic_octree::ColumnScanner(ground.map()).scan(tileOf(obstacle.column));
  const int column = indexInTile(obstacle.column), height = ground.layers().shape().height;
  for (const Run* run = tile.runs.begin(column); run != tile.runs.end(column); ++run)
    if (run->top > obstacle.z + step && run->bottom <= obstacle.z + height)
      return standing(checker, run->topClass, run->top - z);
  return tile.isOverDrop(column, obstacle.z, obstacle.z, step, height) ? "a drop"
                                                                       : "ground not known";
}

/** What is nearest to the footprint's discs of all that is in their way. */
Refusal blocking(const CollisionChecker& checker, const GroundPose& pose) {
  const Ground& ground = checker.ground();
  const Placement placed(pose.pose);
  double nearest = std::numeric_limits<double>::infinity();
  Obstacle obstacle{ground.columnAt(pose.pose.x, pose.pose.y), pose.z, 0};
  for (const CollisionChecker::CheckedDisc& d : checker.discs()) {
    const auto [x, y] = placed(d.disc.x, d.disc.y);
    const Column c = ground.columnAt(x, y);
    const Surface* s = ground.near(c, pose.z, d.tolerance);
    const auto found = s && s->drivable ? ground.layers().obstacleNear(c, s->z)
                                        : Obstacle{c, s ? s->z : pose.z, 0};
    if (!found || found->clearance2 >= d.needed2) continue;
    const double distance = std::sqrt(found->clearance2) - std::sqrt(d.needed2);
    if (distance < nearest) obstacle = *found;
    nearest = std::min(nearest, distance);
  }
  return {{ground.centerOf(obstacle.column.x), ground.centerOf(obstacle.column.y)},
          whatIsAt(checker, obstacle, pose.z)};
}

/** The first wheel that is over forbidden ground. */
Refusal underWheels(const CollisionChecker& checker, const GroundPose& pose) {
  const Ground& ground = checker.ground();
  const ClassId id = checker.classAt(pose);
  const Placement placed(pose.pose);
  Column column = ground.columnAt(pose.pose.x, pose.pose.y);
  for (const double wheel : checker.wheels()) {
    const auto [x, y] = placed(0, wheel);
    const Column c = ground.columnAt(x, y);
    const Surface* s = ground.near(c, pose.z, 2 * ground.step());
    if (s && s->classId == id) column = c;
  }
  return {{ground.centerOf(column.x), ground.centerOf(column.y)}, forbidden(ground, id)};
}

}  // namespace

Refusal refusalOf(const CollisionChecker& checker, PlanStatus status,
                  const mrpt::math::TPose2D& pose, const std::optional<GroundPose>& placed) {
  const Ground& ground = checker.ground();
  if (status == PlanStatus::StartForbidden) return underWheels(checker, *placed);
  if (status == PlanStatus::StartBlocked) return blocking(checker, *placed);
  const bool isSteep = !ground.surfaces(ground.columnAt(pose.x, pose.y)).empty();
  return {{pose.x, pose.y}, isSteep ? "ground too steep" : "ground not known"};
}

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
