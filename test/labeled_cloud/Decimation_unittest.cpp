#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <random>

#include "Conversions.h"
#include "PoleBeforeWall.h"

using namespace labeled_cloud;
using Eigen::Vector3f;
using mrpt::obs::CObservation3DRangeScan;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

/** Points whose class is not that of the surface at their depth. */
std::size_t bled(const LabeledScan& scan) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i)
    wrong += scan.cloud.classes[i] != (scan.cloud.points[i].x() < 2 ? 1 : 2);
  return wrong;
}

}  // namespace

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

namespace {

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
