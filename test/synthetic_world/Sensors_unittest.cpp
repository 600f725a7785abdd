#include <gtest/gtest.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using V = Eigen::Vector3d;

Eigen::Isometry3d raised(double height) {
  return Eigen::Isometry3d(Eigen::Translation3d(0, 0, height));
}

TEST(Lidar, ringsOnFlatGroundAreCirclesOfKnownRadiusThatTurnLeft) {
  LidarOptions options;
  options.rings = 5, options.columns = 360, options.lowest = -30, options.highest = -10;
  const LabeledCloud cloud = scanLidar(small_world::flat(), raised(2), options);
  ASSERT_EQ(cloud.size(), 5u * 360u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double elevation = (10 + 5.0 * static_cast<double>(i / 360)) * M_PI / 180;
    EXPECT_NEAR(cloud.points[i].head<2>().norm(), 2 / std::tan(elevation), 1e-4);
    EXPECT_NEAR(cloud.points[i].z(), -2, 1e-5);
    const double left = static_cast<double>(i % 360) * M_PI / 180;
    EXPECT_NEAR(
        std::remainder(std::atan2(cloud.points[i].y(), cloud.points[i].x()) - left, 2 * M_PI), 0,
        1e-5);
    EXPECT_EQ(cloud.classes[i], kGrass);
  }
}

TEST(Lidar, pointsAreOnSurfacesOfTheirClass) {
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 6);
    const Eigen::Isometry3d T = scene.T_world_robot(60) * raised(1.8);
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
  const Eigen::Isometry3d T = scene.T_world_robot(60) * raised(1.8);
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

TEST(Lidar, itsHighestRingIsNotBelowItsLowest) {
  LidarOptions options;
  options.lowest = options.highest + 1;
  const auto error = errorOf([&] { scanLidar(small_world::flat(), raised(1), options); });
  EXPECT_TRUE(contains(error, "LidarOptions::lowest"));
}

CameraFrame wall(const SensorNoise& noise, FrameSeed seed = {}) {
  CameraOptions options;
  options.noise = noise, options.color = false;
  Eigen::Isometry3d T(Eigen::Translation3d(0, 0, 4));
  options.horizontalFov = 60;
  return renderCamera(small_world::withWall(), T, options, seed);
}

TEST(SensorNoise, isAsAskedInDepthsAndLabels) {
  const CameraFrame clean = wall({}), noisy = wall({0.05, 0.4});
  double n = 0, sum = 0, square = 0;
  std::vector<double> counts(kClassCount + 1);
  for (std::size_t i = 0; i < clean.depth.pixels.size(); ++i) {
    const float depth = noisy.depth.pixels[i];
    EXPECT_EQ(depth > 0, noisy.labels.pixels[i] != kNoClass);
    if (clean.labels.pixels[i] != kWall) continue;
    ++n, ++counts[noisy.labels.pixels[i]];
    sum += depth - 5, square += (depth - 5) * (depth - 5);
  }
  ASSERT_GT(n, 30000);
  EXPECT_NEAR(sum / n, 0, 0.001);
  EXPECT_NEAR(std::sqrt(square / n), 0.05, 0.001);
  for (int id = 1; id <= kClassCount; ++id)  // every other class alike
    EXPECT_NEAR(counts[id] / n, id == kWall ? 0.6 : 0.4 / (kClassCount - 1), 0.01) << id;
}

TEST(SensorNoise, isTheSameForTheSameSeedAndFrameOnly) {
  const SensorNoise noise{0.05, 0.1};
  EXPECT_EQ(wall(noise, {1, 7}).depth.pixels, wall(noise, {1, 7}).depth.pixels);
  EXPECT_NE(wall(noise, {1, 7}).depth.pixels, wall(noise, {1, 8}).depth.pixels);
  EXPECT_NE(wall(noise, {1, 7}).depth.pixels, wall(noise, {2, 7}).depth.pixels);
}

TEST(SensorNoise, lidarScattersAlongItsBeams) {
  LidarOptions options;
  options.rings = 1, options.lowest = options.highest = 0, options.columns = 4000;
  options.noise = {0.03, 0.2};
  const Eigen::Isometry3d T(Eigen::Translation3d(0, 0, 2));
  const LabeledCloud cloud = scanLidar(small_world::withWall(), T, options);
  double square = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& p = cloud.points[i];
    const double error = p.norm() * (1 - 5 / p.x());
    square += error * error, wrong += cloud.classes[i] != kWall;
    EXPECT_NEAR(p.z(), 0, 1e-6);
  }
  EXPECT_NEAR(std::sqrt(square / cloud.size()), 0.03, 0.003);
  EXPECT_NEAR(wrong / double(cloud.size()), 0.2, 0.03);
}

using State = PointTruth::State;

TEST(Camera, fieldOfViewIsTheAskedOne) {
  CameraOptions options;
  options.horizontalFov = 90;
  // From the outer edge of the first pixel to that of the last.
  const V left = options.ray(100, -0.5), right = options.ray(100, 319.5);
  EXPECT_NEAR(std::atan2(left.y(), left.x()), M_PI / 4, 1e-12);
  EXPECT_NEAR(std::atan2(right.y(), right.x()), -M_PI / 4, 1e-12);
  EXPECT_GT(options.ray(0, 160).z(), 0);  // the first row looks up
}

TEST(Camera, everyPixelLiesOnASurfaceOfItsClass) {
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 4);
    CameraOptions options;
    options.maxRange = 60, options.color = false;
    Eigen::Isometry3d T = scene.T_world_robot(34.5);
    T.translate(V(0, 0, 1.4));
    const CameraFrame frame = renderCamera(scene.world, T, options);
    int pixels = 0, wrong = 0;
    for (int row = 0; row < options.height; row += 2)
      for (int column = 0; column < options.width; column += 2) {
        const double depth = frame.depth.at(row, column);
        if (depth == 0) continue;
        const V p = T * (depth * options.ray(row, column));
        const PointTruth truth = scene.world.at(p, 1e-4);
        EXPECT_EQ(truth.state, State::Surface) << name << ' ' << row << ' ' << column;
        wrong += truth.id != frame.labels.at(row, column);  // depths are floats: borders may differ
        ++pixels;
      }
    EXPECT_GT(pixels, 5000) << name;
    EXPECT_LE(wrong, pixels / 2000) << name;
  }
}

TEST(Camera, colorIsOptionalAndChangesNothingElse) {
  const Scene scene = makeScene("village", 1);
  CameraOptions options;
  options.width = 80, options.height = 60;
  options.noise = {0.02, 0.1};
  Eigen::Isometry3d T = scene.T_world_robot(7.5);
  T.translate(V(0, 0, 1.4));
  const CameraFrame with = renderCamera(scene.world, T, options, {3, 4});
  options.color = false;
  const CameraFrame without = renderCamera(scene.world, T, options, {3, 4});
  EXPECT_TRUE(without.color.empty());
  EXPECT_EQ(with.color.pixels.size(), 80u * 60u);
  EXPECT_EQ(with.depth.pixels, without.depth.pixels);
  EXPECT_EQ(with.labels.pixels, without.labels.pixels);
}

}  // namespace
