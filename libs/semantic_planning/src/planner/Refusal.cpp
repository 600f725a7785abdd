#include "Refusal.h"

#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>

#include "ground/GroundAround.h"
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

}  // namespace semantic_planning
