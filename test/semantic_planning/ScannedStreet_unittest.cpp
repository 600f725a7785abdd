// The ground of streets as a LiDAR sees them: holes between rings are ground, ditches are not.
#include "ScannedStreet.h"

#include <gtest/gtest.h>

#include "PaintedGround.h"

using namespace painted_ground;
using Lidar = ScannedStreet::Lidar;

namespace {

constexpr double kRoad = 0.05;  ///< height, m: not at a border of voxels

/** Flat ground but for a trench beside the lane, from x = `from` to `to`. */
auto trench(double from, double to, double depth) {
  return [=](double x) { return x > from && x < to ? kRoad - depth : kRoad; };
}

Ground groundFor(const SemanticOcTree& map) {
  return Ground(map, VehicleOptions(), GroundOptions(), anyClass());
}

/** Whether wheels get straight from x = `from` to `to` at some y, step by step. */
bool isCrossed(const Ground& ground, double from, double to, double y) {
  const auto begin = ground.find(from, y, kRoad);
  if (!begin) return false;
  int z = begin->surface.z;
  for (int x = begin->column.x + 1; x <= ground.keyOf(to); ++x) {
    const Surface* s = ground.near({x, begin->column.y}, z, ground.step());
    if (!s || !s->drivable) return false;
    z = s->z;
  }
  return true;
}

/** The share of rows from y = -3 to 3 m in which the trench is crossed. */
double shareCrossed(const Ground& ground, double from, double to) {
  int crossed = 0, rows = 0;
  for (double y = -3; y <= 3; y += ground.voxelSize(), ++rows)
    crossed += isCrossed(ground, from, to, y);
  return double(crossed) / rows;
}

}  // namespace

TEST(ScannedStreet, aTrenchThatSeveralScansSawStaysAnObstacle) {
  for (const double voxelSize : {0.1, 0.2, 0.3, 0.4})
    for (const int rings : {16, 64})
      for (const double depth : {0.5, 1.0, 3.0}) {
        if (depth < 1.3 * voxelSize) continue;  // a voxel's step cannot be told from a slope
        ScannedStreet street(voxelSize);
        for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0})
          street.scan(trench(2.5, 4.3, depth), y, {rings});
        EXPECT_LT(shareCrossed(groundFor(street.map), 2, 4.8), 0.02)
            << voxelSize << ' ' << rings << ' ' << depth;
      }
}

TEST(ScannedStreet, aTrenchThatOneScanSawIsAnObstacle) {
  ScannedStreet street(0.2);
  street.scan(trench(2.5, 4.3, 1), 0, {64});
  EXPECT_LT(shareCrossed(groundFor(street.map), 2, 4.8), 0.02);
}

TEST(ScannedStreet, theEdgeOfAPlatformIsAnObstacle) {
  for (const double voxelSize : {0.1, 0.2, 0.4}) {
    ScannedStreet street(voxelSize);
    for (const double y : {-1.0, 0.0, 1.0}) street.scan(trench(1.5, 30, 1.2), y, {64, 720, -60, 5});
    const Ground ground = groundFor(street.map);
    EXPECT_LT(shareCrossed(ground, 1.2, 4), 0.02) << voxelSize;
    const Surface* edge = ground.near(ground.columnAt(1.3, 0), ground.keyOf(kRoad), 1);
    ASSERT_NE(edge, nullptr);
    EXPECT_FALSE(ground.hasClearance(*edge, 0.5));
  }
}

TEST(ScannedStreet, ghostsBelowTheRoadMakeNoDitches) {
  const auto flat = [](double) { return kRoad; };
  for (const double voxelSize : {0.1, 0.2, 0.4})
    for (const int rings : {16, 64}) {
      ScannedStreet street(voxelSize), haunted(voxelSize);
      for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
        street.scan(flat, y, {rings});
        haunted.scan(flat, y, {rings}, 0.003);
      }
      const Ground ground = groundFor(street.map), same = groundFor(haunted.map);
      int free = 0, lost = 0;
      for (double x = 2; x < 8; x += voxelSize)
        for (double y = -4; y < 4; y += voxelSize) {
          const auto at = ground.find(x, y), haunt = same.find(x, y);
          if (!at || !ground.hasClearance(at->surface, 0.3)) continue;
          ++free;
          lost += !haunt || haunt->surface.z != at->surface.z ||
                  !same.hasClearance(haunt->surface, 0.3);
        }
      EXPECT_GT(free, 100) << voxelSize << ' ' << rings;
      EXPECT_LT(lost, free / 50) << voxelSize << ' ' << rings;
    }
}

TEST(ScannedStreet, aTrenchStaysAnObstacleAmongGhosts) {
  ScannedStreet street(0.2);
  for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0})
    street.scan(trench(2.5, 4.3, 1), y, {64}, 0.01);
  EXPECT_LT(shareCrossed(groundFor(street.map), 2, 4.8), 0.02);
}

TEST(ScannedStreet, singleVoxelsOfAForbiddenClassAreGroundOfThatAroundThem) {
  PaintedWorld world;
  world.floor(-4, 4, -4, 4, PaintedWorld::Road);
  world.voxel(0, 0, -1, PaintedWorld::Wall);
  world.box(1, 2, 1, 2, -0.2, 0, PaintedWorld::Wall);
  const colored_graph::ClassOrder order{5, {{1}, {2}, {0}}};
  const Ground ground(world.map(), VehicleOptions(), GroundOptions(), order);
  EXPECT_EQ(ground.find(0.1, 0.1)->surface.classId, PaintedWorld::Road);
  EXPECT_EQ(ground.find(1.5, 1.5)->surface.classId, PaintedWorld::Wall);
  EXPECT_EQ(ground.find(1.1, 1.5)->surface.classId, PaintedWorld::Wall);
}

TEST(ScannedStreet, whereFewColumnsWereHitThoseBeyondTellAForbiddenClass) {
  const colored_graph::ClassOrder order(5, {{PaintedWorld::Road, 0}});
  const auto classOfMiddle = [&](bool withNext) {
    PaintedWorld world;
    world.voxel(0, 0, -1, PaintedWorld::Mud).voxel(1, 0, -1, PaintedWorld::Mud);
    if (withNext)
      for (const int y : {-1, 1})
        world.voxel(0, y, -1, PaintedWorld::Mud).voxel(1, y, -1, PaintedWorld::Mud);
    for (const int x : {-2, 2})
      for (int y = -2; y <= 2; ++y) world.voxel(x, y, -1, PaintedWorld::Road);
    const Ground ground(world.map(), VehicleOptions(), GroundOptions(), order);
    constexpr int kMiddle = semantic_octree::kKeyOfOrigin;
    return ground.near({kMiddle, kMiddle}, kMiddle - 1, 0)->classId;
  };
  EXPECT_EQ(classOfMiddle(false), PaintedWorld::Road);
  EXPECT_EQ(classOfMiddle(true), PaintedWorld::Mud);
}

TEST(ScannedStreet, forbiddenClassesThatDifferDoNotAddUp) {
  const colored_graph::ClassOrder order(5, {{PaintedWorld::Road, 0}});
  const auto classOfMiddle = [&](PaintedWorld::Class left, PaintedWorld::Class right) {
    PaintedWorld world;
    world.floor(-1, 1, -1, 1, PaintedWorld::Road).voxel(0, 0, -1, PaintedWorld::Mud);
    for (const int y : {-1, 1}) world.voxel(-1, y, -1, left).voxel(1, y, -1, right);
    const Ground ground(world.map(), VehicleOptions(), GroundOptions(), order);
    constexpr int kMiddle = semantic_octree::kKeyOfOrigin;
    return ground.near({kMiddle, kMiddle}, kMiddle - 1, 0)->classId;
  };
  EXPECT_EQ(classOfMiddle(PaintedWorld::Grass, PaintedWorld::Wall), PaintedWorld::Road);
  EXPECT_EQ(classOfMiddle(PaintedWorld::Mud, PaintedWorld::Mud), PaintedWorld::Mud);
  EXPECT_EQ(classOfMiddle(PaintedWorld::Mud, PaintedWorld::Wall), PaintedWorld::Mud);
}
