#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include "Conversions.h"
#include "DepthCamera.h"

using namespace labeled_cloud;
using Eigen::Vector3f;
using mrpt::obs::CObservation3DRangeScan;
using semantic_types::ClassTable;

namespace {

/** A pole in front of a wall, class a and b; distances in m. */
constexpr double kPole = 1, kWall = 3;

inline bool onPole(int, int col) { return col >= 23 && col < 30; }

inline mrpt::obs::CObservation3DRangeScan::Ptr poleBeforeWall(const DepthCamera& camera) {
  auto scan = camera.see([](int r, int c) { return onPole(r, c) ? kPole : kWall; });
  camera.label(*scan, [](int r, int c) { return onPole(r, c) ? 1 : 2; });
  return scan;
}

TEST(RangeImages, rangesAlongTheRayAreNoDepths) {
  const DepthCamera camera;
  auto obs = camera.see([](int, int) { return 2; });
  obs->range_is_depth = false;
  for (const Vector3f& p : convert(*obs).cloud.points) EXPECT_NEAR(p.norm(), 2, 1e-5);
}

TEST(RangeImages, lensDistortionIsTakenOut) {
  const DepthCamera camera;
  constexpr double k1 = -0.3, k2 = 0.1, p1 = 0.002, p2 = -0.001, k3 = 0.02;
  auto obs = camera.see([](int, int) { return 2; });
  obs->cameraParams.setDistortionPlumbBob(k1, k2, p1, p2, k3);
  const auto scan = convert(*obs);
  for (int r = 0, i = 0; r < camera.rows; ++r)
    for (int c = 0; c < camera.cols; ++c, ++i) {
      const Vector3f& p = scan.cloud.points[i];
      const double x = -p.y() / p.x(), y = -p.z() / p.x(), r2 = x * x + y * y;
      const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
      const double u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
      const double v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
      EXPECT_NEAR(camera.f * u + camera.cx, c, 1e-3);
      EXPECT_NEAR(camera.f * v + camera.cy, r, 1e-3);
    }
}

TEST(RangeImages, agreeWithMrptsOwnUnprojection) {
  auto obs = DepthCamera().see([](int r, int c) { return 1 + 0.05 * r + 0.01 * c; });
  mrpt::maps::CSimplePointsMap map;
  obs->unprojectInto(map);
  const auto scan = convert(*obs);
  ASSERT_EQ(map.size(), scan.cloud.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    float x, y, z;
    map.getPoint(i, x, y, z);
    EXPECT_LT((scan.cloud.points[i] - Vector3f(x, y, z)).norm(), 1e-5);
  }
}

TEST(RangeImages, keepPoseTimeAndLabel) {
  auto obs = DepthCamera().see([](int, int) { return 1; });
  obs->sensorPose = mrpt::poses::CPose3D(1, 2, 3, 0.1, 0.2, 0.3);
  const auto scan = convert(*obs);
  EXPECT_EQ(scan.T_robot_sensor, obs->sensorPose);
  EXPECT_EQ(scan.timestamp, obs->timestamp);
  EXPECT_EQ(scan.sensorLabel, "cam");
}

TEST(RangeImages, pixelsWithoutRangeAreDroppedAndCounted) {
  const auto scan = convert(*DepthCamera().see([](int r, int) { return r < 3 ? 0 : 1; }));
  EXPECT_EQ(scan.counts.invalid, 3u * 60);
  EXPECT_EQ(scan.counts.points, 37u * 60);
  EXPECT_EQ(scan.cloud.size(), 37u * 60);
}

TEST(RangeImages, eachPointHasTheLabelOfItsOwnPixelInEveryWidthOfBitField) {
  const DepthCamera camera;
  const auto labelOf = [](int r, int c) { return (7 * r + c) % 4 - 1 < 0 ? -1 : (7 * r + c) % 4; };
  auto obs = camera.see([](int r, int) { return r % 5 == 0 ? 0 : 2; });
  const auto check = [&] {
    const auto scan = convert(*obs);
    std::size_t i = 0, labeled = 0;
    for (int r = 0; r < camera.rows; ++r)
      for (int c = 0; c < camera.cols; ++c) {
        if (r % 5 == 0) continue;
        const int expected = std::max(0, labelOf(r, c));
        labeled += expected > 0;
        ASSERT_EQ(scan.cloud.classes[i++], expected);
      }
    EXPECT_EQ(scan.counts.labeled, labeled);
    EXPECT_FALSE(scan.labelsMissing);
  };
  camera.label<1>(*obs, labelOf), check();
  camera.label<2>(*obs, labelOf), check();
  camera.label<4>(*obs, labelOf), check();
  camera.label<8>(*obs, labelOf), check();
}

TEST(RangeImages, labelsGoByTheirNamesAndTheLowestOfSeveralCounts) {
  const DepthCamera camera;
  auto obs = camera.see([](int, int) { return 2; });
  camera.label(*obs, [](int r, int) { return r == 0 ? 63 : 0; });
  obs->pixelLabels->setLabelName(63, "c");
  obs->pixelLabels->setLabelName(0, "b");
  obs->pixelLabels->setLabel(1, 0, 63);
  const auto scan = convert(*obs);
  EXPECT_EQ(scan.cloud.classes[0], 3);
  EXPECT_EQ(scan.cloud.classes[60], 2);
}

TEST(RangeImages, withoutLabelsAllPointsCountForOccupancyOnly) {
  const auto scan = convert(*DepthCamera().see([](int, int) { return 2; }));
  EXPECT_TRUE(scan.labelsMissing);
  EXPECT_TRUE(scan.cloud.classes.empty());
  EXPECT_EQ(scan.counts.labeled, 0u);
}

TEST(RangeImages, aLabelThatTheTableDoesNotKnowIsNamedOrIsNoClass) {
  const DepthCamera camera;
  auto obs = camera.see([](int, int) { return 2; });
  camera.label(*obs, [](int, int) { return 41; });
  EXPECT_TRUE(contains(errorConverting(*obs), "raw class id 41 is not in the class table"));
  ClassTable lenient = abc();
  lenient.setUnknownRawId(ClassTable::UnknownRawId::NoClass);
  EXPECT_EQ(ScanConverter(lenient).convert(*obs)->counts.labeled, 0u);
  obs->pixelLabels->setLabelName(41, "zebra");
  EXPECT_TRUE(contains(errorConverting(*obs), "label 41 is named 'zebra'"));
  EXPECT_EQ(ScanConverter(lenient).convert(*obs)->counts.labeled, 0u);
}

TEST(RangeImages, unusableOnesSayWhy) {
  const DepthCamera camera;
  auto obs = camera.see([](int, int) { return 2; });
  obs->hasRangeImage = false;
  EXPECT_EQ(errorConverting(*obs), "CObservation3DRangeScan 'cam' at 10 s: it has no range image");
  obs->hasRangeImage = true;
  obs->cameraParams.ncols = 61;
  EXPECT_TRUE(contains(errorConverting(*obs), "has 60 x 40 pixels"));
  EXPECT_TRUE(contains(errorConverting(*obs), "calibrated for 61 x 40"));
  obs->cameraParams.ncols = 60;
  obs->cameraParams.setIntrinsicParamsFromValues(0, 0, 0, 0);
  EXPECT_TRUE(contains(errorConverting(*obs), "not calibrated: fx = 0"));
  obs = camera.see([](int, int) { return 2; });
  DepthCamera other;
  other.rows = 20;
  other.label(*obs, [](int, int) { return 1; });
  EXPECT_TRUE(contains(errorConverting(*obs),
                       "the label image has 60 x 20 pixels, the depth image "
                       "60 x 40"));
}

TEST(RangeImages, ofMorePixelsThanMemoryMayHoldAreRefused) {
  auto obs = DepthCamera().see([](int, int) { return 2; });
  obs->cameraParams.ncols = obs->cameraParams.nrows = 18000;
  EXPECT_TRUE(
      contains(errorConverting(*obs), "a camera of 18000 x 18000 pixels; 40 million are allowed"));
}

TEST(RangeImages, externallyStoredOnesAreLoadedAndUnloaded) {
  const TemporaryFolder folder;
  auto obs = DepthCamera().see([](int r, int c) { return 1 + 0.01 * r + 0.02 * c; });
  const auto inMemory = convert(*obs).cloud.points;
  mrpt::img::CImage::setImagesPathBase(folder.path().string());
  obs->rangeImage_convertToExternalStorage("range.bin", folder.path().string() + "/");
  obs->unload();
  ASSERT_EQ(obs->rangeImage.size(), 0);
  EXPECT_EQ(convert(*obs).cloud.points, inMemory);
  EXPECT_EQ(obs->rangeImage.size(), 0);
  std::filesystem::remove(folder / "range.bin");
  EXPECT_TRUE(contains(errorConverting(*obs), "range.bin"));
}

/** Points whose class is not that of the surface at their depth. */
std::size_t bled(const LabeledScan& scan) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    wrong += scan.cloud.classes[i] != (scan.cloud.points[i].x() < 2 ? 1 : 2);
  return wrong;
}

TEST(Decimation, takesTheNearestPointOfEachBlockAndNoLabelBleeds) {
  const auto obs = poleBeforeWall(DepthCamera());
  for (const int d : {2, 3, 4, 5, 7}) {
    ScanConverterOptions options;
    options.decimation = d;
    const auto scan = convert(*obs, options);
    EXPECT_EQ(scan.cloud.size(), std::size_t((40 + d - 1) / d) * ((60 + d - 1) / d));
    EXPECT_EQ(bled(scan), 0u) << "decimation " << d;
    std::size_t near = 0;
    for (const Vector3f& p : scan.cloud.points) near += p.x() < 2;
    const int columns = 29 / d - 23 / d + 1;  // blocks that the pole touches
    EXPECT_EQ(near, std::size_t(columns * ((40 + d - 1) / d))) << "decimation " << d;
  }
}

ScanConverterOptions withoutFlying() {
  ScanConverterOptions options;
  options.flyingPixelThreshold = 0.03;
  return options;
}

}  // namespace

TEST(FlyingPixels, betweenTwoSurfacesAreRemovedAndCountedAndNothingElse) {
  for (const int width : {1, 2}) {
    const auto depth = [width](int, int c) {
      if (c >= 20 && c < 20 + width) return 1 + 2.0 * (c - 19) / (width + 1);
      return c < 20 ? 1.0 : 3.0;
    };
    const auto scan = convert(*DepthCamera().see(depth), withoutFlying());
    EXPECT_EQ(scan.counts.flying, std::size_t(40 * width)) << "width " << width;
    for (const Vector3f& p : scan.cloud.points)
      EXPECT_LT(std::min(std::abs(p.x() - 1), std::abs(p.x() - 3)), 1e-3);
  }
  const auto lying = DepthCamera().see([](int r, int) { return r < 20 ? 1 : r == 20 ? 2 : 3; });
  EXPECT_EQ(convert(*lying, withoutFlying()).counts.flying, 60u);
  // two pixels on a line with the surface behind them are no surface of their own
  const auto band = DepthCamera().see([](int, int c) {
    return c < 20 ? 1.0 : c == 20 ? 9.0 / 7 : c == 21 ? 9.0 / 5 : 3.0;
  });
  EXPECT_EQ(convert(*band, withoutFlying()).counts.flying, 80u);
  const auto all = convert(*DepthCamera().see([](int, int c) {
    return c < 20 ? 1 : c == 20 ? 2 : 3;
  }));
  EXPECT_EQ(all.counts.flying, 0u);
  EXPECT_EQ(all.cloud.size(), 2400u);
}

TEST(FlyingPixels, sharpEdgesThinPolesAndSlantedGroundStay) {
  const DepthCamera camera;
  const auto ground = [&](int r, int) {  // 1 m below the camera, seen at ever flatter angles
    return r > camera.cy + 1 ? camera.f / (r - camera.cy) : 0;
  };
  EXPECT_EQ(convert(*poleBeforeWall(camera), withoutFlying()).counts.flying, 0u);
  EXPECT_EQ(convert(*camera.see(ground), withoutFlying()).counts.flying, 0u);
  const auto pole = camera.see([](int, int c) { return c == 30 ? 1 : 3; });
  EXPECT_EQ(convert(*pole, withoutFlying()).counts.flying, 0u);
}
