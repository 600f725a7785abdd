#include <gtest/gtest.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using V = Eigen::Vector3d;

Eigen::Isometry3d raised(double height) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().z() = height;
  return T;
}

TEST(Lidar, ringsOnFlatGroundAreCirclesOfKnownRadius) {
  LidarOptions options;
  options.rings = 5, options.columns = 360, options.lowest = -30, options.highest = -10;
  const LabeledCloud cloud = scanLidar(small_world::flat(), raised(2), options);
  ASSERT_EQ(cloud.size(), 5u * 360u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double elevation = (10 + 5.0 * static_cast<double>(i / 360)) * M_PI / 180;
    EXPECT_NEAR(cloud.points[i].head<2>().norm(), 2 / std::tan(elevation), 1e-4);
    EXPECT_NEAR(cloud.points[i].z(), -2, 1e-5);
    EXPECT_EQ(cloud.classes[i], kGrass);
  }
}

TEST(Lidar, columnsTurnLeftFromAhead) {
  LidarOptions options;
  options.columns = 4, options.rings = 1, options.lowest = options.highest = 0;
  EXPECT_NEAR((options.beam(0, 0) - V::UnitX()).norm(), 0, 1e-12);
  EXPECT_NEAR((options.beam(0, 1) - V::UnitY()).norm(), 0, 1e-12);
}

TEST(Lidar, pointsAreOnSurfacesOfTheirClass) {
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 6);
    const Eigen::Isometry3d T = Drive(scene).T_world_robot(40) * raised(1.8);
    const LabeledCloud cloud = scanLidar(scene.world, T, LidarOptions());
    int wrong = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const PointTruth truth = scene.world.at(T * cloud.points[i].cast<double>(), 1e-4);
      EXPECT_EQ(truth.state, PointTruth::State::Surface);
      wrong += truth.id != cloud.classes[i];
    }
    EXPECT_GT(cloud.size(), 15000u);
    EXPECT_LE(wrong, static_cast<int>(cloud.size() / 2000)) << name;
  }
}

TEST(Lidar, returnsOutsideItsRangesAreLost) {
  LidarOptions options;
  options.lowest = -80, options.maxRange = 12;
  const LabeledCloud cloud = scanLidar(small_world::withWall(), raised(0.5), options);
  ASSERT_FALSE(cloud.empty());
  for (const auto& p : cloud.points) {
    EXPECT_GE(p.norm(), LidarOptions::kMinRange - 1e-5);
    EXPECT_LE(p.norm(), 12 + 1e-5);
  }
}

TEST(Lidar, ghostsLieOnTheirBeamsBehindMirrorsManyBelowTheGround) {
  const Scene scene = makeScene("campus", 6);
  const Eigen::Isometry3d T = Drive(scene).T_world_robot(40) * raised(1.8);
  LidarOptions options;
  const LabeledCloud plain = scanLidar(scene.world, T, options);
  options.ghosts = 1;
  const LabeledCloud haunted = scanLidar(scene.world, T, options);
  std::size_t ghosts = 0, below = 0;
  for (const auto& p : haunted.points) {
    const V q = T * p.cast<double>(), beam = T.linear() * p.cast<double>().normalized();
    const auto hit = scene.world.castRay(T.translation(), beam, options.maxRange);
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->range, p.norm() + 1e-3);
    if (hit->range > p.norm() - 1e-3) continue;
    ++ghosts;
    const ClassId mirror = hit->material.id;
    EXPECT_TRUE(mirror == kWindow || mirror == kCar || mirror == kWater || mirror == kSign);
    below += q.z() < scene.world.groundHeight(q.x(), q.y()) - 0.5;
  }
  EXPECT_GT(ghosts, 100u);
  EXPECT_GT(below, 20u);
  EXPECT_LT(haunted.size(), plain.size());  // what mirrors show of the sky does not return
}

TEST(Lidar, badOptionsAreNamed) {
  using O = LidarOptions;
  const std::pair<void (*)(O&), const char*> faults[] = {
      {[](O& o) { o.rings = 0; }, "LidarOptions::rings"},
      {[](O& o) { o.columns = 0; }, "LidarOptions::columns"},
      {[](O& o) { o.lowest = 20; }, "LidarOptions::lowest"},
      {[](O& o) { o.highest = 90; }, "LidarOptions::highest"},
      {[](O& o) { o.maxRange = 0; }, "LidarOptions::max_range"},
      {[](O& o) { o.ghosts = 2; }, "ghosts"},
      {[](O& o) { o.noise.range = -1; }, "range_noise"}};
  for (const auto& [change, words] : faults) {
    O options;
    change(options);
    const auto error = errorOf([&, &o = options] { scanLidar(small_world::flat(), raised(1), o); });
    EXPECT_TRUE(contains(error, words)) << error;
  }
}

}  // namespace
