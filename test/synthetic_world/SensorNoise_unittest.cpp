#include <gtest/gtest.h>
#include <synthetic_world/Sensors.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;

TEST(Random, isTheSameEverywhere) {
  Random random(1);  // SplitMix64 of a scrambled seed
  const std::uint64_t first = random.next(), second = random.next();
  EXPECT_EQ(first, 0x5e41ab087439611eull);
  EXPECT_EQ(second, 0xf18d6ce93d6cf1eeull);
}

TEST(Random, normalVariatesHaveTheMomentsOfTheNormalDistribution) {
  Random random(2);
  const int n = 400000;
  double sum = 0, square = 0, cube = 0, fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    sum += x, square += x * x, cube += x * x * x, fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / n, 0, 0.01);
  EXPECT_NEAR(square / n, 1, 0.01);
  EXPECT_NEAR(cube / n, 0, 0.03);
  EXPECT_NEAR(fourth / n, 3, 0.08);
}

CameraFrame wall(const SensorNoise& noise, FrameSeed seed = {}) {
  CameraOptions options;
  options.noise = noise, options.color = false;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().z() = 4;
  options.horizontalFov = 60;
  return renderCamera(small_world::withWall(), T, options, seed);
}

TEST(SensorNoise, depthsScatterAroundTheTruthAsAsked) {
  const CameraFrame frame = wall({0.05, 0, 0});
  double sum = 0, square = 0;
  int n = 0;
  for (std::size_t i = 0; i < frame.depth.pixels.size(); ++i) {
    if (frame.labels.pixels[i] != kWall) continue;
    const double error = frame.depth.pixels[i] - 5;
    sum += error, square += error * error, ++n;
  }
  ASSERT_GT(n, 40000);
  EXPECT_NEAR(sum / n, 0, 0.001);
  EXPECT_NEAR(std::sqrt(square / n), 0.05, 0.001);
}

TEST(SensorNoise, wrongLabelsAreEveryOtherClassAlike) {
  const CameraFrame clean = wall({}), noisy = wall({0, 0.4, 0});
  std::vector<int> counts(kClassCount + 1);
  int n = 0;
  for (std::size_t i = 0; i < clean.labels.pixels.size(); ++i) {
    if (clean.labels.pixels[i] != kWall) continue;
    ++counts[noisy.labels.pixels[i]], ++n;
  }
  EXPECT_EQ(clean.depth.pixels, noisy.depth.pixels);
  EXPECT_EQ(counts[kNoClass], 0);
  for (int id = 1; id <= kClassCount; ++id)
    EXPECT_NEAR(counts[id] / double(n), id == kWall ? 0.6 : 0.4 / (kClassCount - 1), 0.01) << id;
}

TEST(SensorNoise, droppedRaysHaveNeitherDepthNorLabel) {
  const CameraFrame clean = wall({}), noisy = wall({0, 0, 0.25});
  int before = 0, after = 0;
  for (std::size_t i = 0; i < clean.depth.pixels.size(); ++i) {
    before += clean.depth.pixels[i] > 0, after += noisy.depth.pixels[i] > 0;
    EXPECT_EQ(noisy.depth.pixels[i] > 0, noisy.labels.pixels[i] != kNoClass);
  }
  EXPECT_NEAR(after / double(before), 0.75, 0.01);
}

TEST(SensorNoise, isTheSameForTheSameSeedAndFrameOnly) {
  const SensorNoise noise{0.05, 0.1, 0.1};
  EXPECT_EQ(wall(noise, {1, 7}).depth.pixels, wall(noise, {1, 7}).depth.pixels);
  EXPECT_NE(wall(noise, {1, 7}).depth.pixels, wall(noise, {1, 8}).depth.pixels);
  EXPECT_NE(wall(noise, {1, 7}).depth.pixels, wall(noise, {2, 7}).depth.pixels);
}

TEST(SensorNoise, lidarScattersAlongItsBeams) {
  LidarOptions options;
  options.rings = 1, options.lowest = options.highest = 0, options.columns = 4000;
  options.noise = {0.03, 0.2, 0.1};
  const Eigen::Isometry3d T(Eigen::Translation3d(0, 0, 2));
  const LabeledCloud cloud = scanLidar(small_world::withWall(), T, options);
  LabeledCloud clean;
  options.noise = {};
  clean = scanLidar(small_world::withWall(), T, options);
  EXPECT_NEAR(cloud.size() / double(clean.size()), 0.9, 0.03);
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

}  // namespace
