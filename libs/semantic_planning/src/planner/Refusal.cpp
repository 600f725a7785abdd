#include "Refusal.h"

#include <algorithm>
#include <cmath>

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

std::string standing(const Ground& ground, ClassId id) {
  return "an obstacle (" + named(ground, id) + ")";
}

/** A surface at this height, in a column or one next to it; or null. */
const Surface* surfaceAround(const Ground& ground, Column c, int z) {
  for (int y = c.y - 1; y <= c.y + 1; ++y)
    for (int x = c.x - 1; x <= c.x + 1; ++x)
      if (const Surface* s = ground.near({x, y}, z, 0)) return s;
  return nullptr;
}

/** \param z of the ground that the vehicle stands upon */
std::string whatIsAt(const Ground& ground, const Obstacle& obstacle, int z) {
  const int step = ground.step();
  if (obstacle.z > z + step)
    if (const Surface* s = surfaceAround(ground, obstacle.column, obstacle.z))
      return standing(ground, s->classId);
  if (const Surface* s = ground.near(obstacle.column, obstacle.z, step))
    return s->drivable ? forbidden(ground, s->classId) : "ground too steep";
  const ColumnTile tile =
      semantic_octree::ColumnScanner(ground.map()).scan(tileOf(obstacle.column));
  const int column = indexInTile(obstacle.column), height = ground.layers().shape().height;
  for (const Run* run = tile.runs.begin(column); run != tile.runs.end(column); ++run)
    if (run->top > obstacle.z + step && run->bottom <= obstacle.z + height)
      return standing(ground, run->topClass);
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
          whatIsAt(ground, obstacle, pose.z)};
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

}  // namespace semantic_planning
