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

TEST(Camera, badOptionsAreNamed) {
  using O = CameraOptions;
  const std::pair<void (*)(O&), const char*> faults[] = {
      {[](O& o) { o.width = 1; }, "CameraOptions::width"},
      {[](O& o) { o.height = 0; }, "CameraOptions::height"},
      {[](O& o) { o.horizontalFov = 180; }, "CameraOptions::fov"},
      {[](O& o) { o.maxRange = 0.2; }, "CameraOptions::max_range"},
      {[](O& o) { o.noise.range = -1; }, "range_noise is -1, expected a number of 0 or more"},
      {[](O& o) { o.noise.label = 2; }, "label_noise is 2, expected a number from 0 to 1"},
      {[](O& o) { o.noise.dropout = NAN; }, "dropout is nan, expected a number from 0 to 1"}};
  for (const auto& [change, words] : faults) {
    O options;
    change(options);
    const auto error =
        errorOf([&, &o = options] { renderCamera(small_world::flat(), lookingAhead(1), o); });
    EXPECT_TRUE(contains(error, words)) << error;
  }
}

}  // namespace
