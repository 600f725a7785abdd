#include <gtest/gtest.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Sensors.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using State = PointTruth::State;
using V = Eigen::Vector3d;

Eigen::Isometry3d lookingAhead(double height) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().z() = height;
  return T;
}

TEST(Camera, depthOfAWallIsItsDistanceInEveryPixel) {
  const CameraFrame frame = renderCamera(small_world::withWall(), lookingAhead(1.5), {});
  int onWall = 0;
  for (int row = 0; row < 240; ++row)
    for (int column = 0; column < 320; ++column)
      if (frame.labels.at(row, column) == kWall) {
        EXPECT_NEAR(frame.depth.at(row, column), 5, 1e-6);
        ++onWall;
      }
  EXPECT_GT(onWall, 30000);
}

TEST(Camera, depthOfFlatGroundFollowsFromTheRow) {
  const CameraOptions options;
  const CameraFrame frame = renderCamera(small_world::flat(), lookingAhead(1.5), options);
  for (int row = 0; row < options.height; ++row) {
    const double down = (row - options.cy()) / options.focalLength(), depth = 1.5 / down;
    for (const int column : {0, 100, 319}) {
      const bool seen = down > 0 && depth <= options.maxRange;
      EXPECT_EQ(frame.labels.at(row, column) == kGrass, seen) << row;
      EXPECT_NEAR(frame.depth.at(row, column), seen ? depth : 0, 1e-5) << row;
    }
  }
}

TEST(Camera, fieldOfViewIsTheAskedOne) {
  CameraOptions options;
  options.horizontalFov = 90;
  // From the outer edge of the first pixel to that of the last.
  const V left = options.ray(100, -0.5), right = options.ray(100, 319.5);
  EXPECT_NEAR(std::atan2(left.y(), left.x()), M_PI / 4, 1e-12);
  EXPECT_NEAR(std::atan2(right.y(), right.x()), -M_PI / 4, 1e-12);
  EXPECT_GT(options.ray(0, 160).z(), 0);  // the first row looks up
}

TEST(Camera, whatIsOnTheLeftIsOnTheLeftOfTheImage) {
  const World world = small_world::flat({small_world::box({8, 3}, {1, 1}, 0, 6, kSign, kSign)});
  const CameraFrame frame = renderCamera(world, lookingAhead(1.5), {});
  const CameraOptions options;
  const int column = static_cast<int>(options.cx() - options.focalLength() * 3 / 7.5);
  EXPECT_EQ(frame.labels.at(100, column), kSign);
  EXPECT_EQ(frame.labels.at(100, 319 - column), kNoClass);
}

TEST(Camera, everyPixelLiesOnASurfaceOfItsClass) {
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 4);
    CameraOptions options;
    options.maxRange = 60, options.color = false;
    Eigen::Isometry3d T = Drive(scene).T_world_robot(23);
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
  options.noise = {0.02, 0.1, 0.1};
  Eigen::Isometry3d T = Drive(scene).T_world_robot(5);
  T.translate(V(0, 0, 1.4));
  const CameraFrame with = renderCamera(scene.world, T, options, {3, 4});
  options.color = false;
  const CameraFrame without = renderCamera(scene.world, T, options, {3, 4});
  EXPECT_TRUE(without.color.empty());
  EXPECT_EQ(with.color.pixels.size(), 80u * 60u);
  EXPECT_EQ(with.depth.pixels, without.depth.pixels);
  EXPECT_EQ(with.labels.pixels, without.labels.pixels);
}

TEST(Camera, colorsLookLikeWhatTheyShow) {
  const CameraFrame frame = renderCamera(small_world::flat(), lookingAhead(1.5), {});
  const Color sky = frame.color.at(5, 160), grass = frame.color.at(230, 160);
  EXPECT_GT(sky.b, sky.r);
  EXPECT_GT(grass.g, grass.r);
  EXPECT_GT(grass.g, grass.b);
}

TEST(Camera, badOptionsAreNamed) {
  using small_world::messageOf;
  const auto message = [](auto change) {
    CameraOptions options;
    change(options);
    return messageOf([&] { renderCamera(small_world::flat(), lookingAhead(1), options); });
  };
  EXPECT_NE(message([](auto& o) { o.width = 1; }).find("CameraOptions::width"), std::string::npos);
  EXPECT_NE(message([](auto& o) { o.height = 0; }).find("CameraOptions::height"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.horizontalFov = 180; }).find("CameraOptions::fov"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.maxRange = 0.2; }).find("CameraOptions::max_range"),
            std::string::npos);
  EXPECT_NE(message([](auto& o) { o.noise.label = 2; }).find("label_noise"), std::string::npos);
}

}  // namespace
