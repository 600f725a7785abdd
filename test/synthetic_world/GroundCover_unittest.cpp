#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/World.h>

#include <cmath>

namespace {

using namespace synthetic_world;
using V2 = Eigen::Vector2d;

TEST(GroundCover, laterStrokesCoverEarlierOnes) {
  GroundCover cover(20, kGrass);
  cover.paintDisk(kGravel, {1, -3}, 4);
  cover.paintStroke(kRoad, {-15, -3}, {15, -3}, 2);
  cover.paintBand(kLaneMarking, {-1, -3}, {1, -3}, 0.2);
  EXPECT_EQ(cover.at(1, 3), kGrass);
  EXPECT_EQ(cover.at(1, -0.5), kGravel);
  EXPECT_EQ(cover.at(5, -3), kRoad);
  EXPECT_EQ(cover.at(0.9, -2.95), kLaneMarking);
  EXPECT_EQ(cover.at(1.05, -3), kRoad);  // a band has square ends
  EXPECT_EQ(cover.at(-1.05, -3), kRoad);
  EXPECT_EQ(cover.at(-16.9, -3), kRoad);  // a stroke has round ones
  EXPECT_EQ(cover.at(-16.9, -2), kGrass);
}

TEST(GroundCover, stripAroundACurveIsWhatLiesWithinItsHalfWidth) {
  const Curve curve({{-15, -9}, {0, -12}, {10, 4}, {-8, 13}}, 5);
  GroundCover cover(20, kGrass);
  cover.paintCurve(kRoad, curve, 2);
  Random random(3);
  int onRoad = 0;
  for (int i = 0; i < 3000; ++i) {
    const V2 p(random.uniform(-20, 20), random.uniform(-20, 20));
    double far = 1e9;
    for (double s = 0; s <= curve.length(); s += 0.02)
      far = std::min(far, (curve.at(s) - p).norm());
    if (std::abs(far - 2) < 0.08) continue;  // the strip is made of straight pieces
    EXPECT_EQ(cover.at(p), far < 2 ? kRoad : kGrass) << p.transpose();
    onRoad += far < 2;
  }
  EXPECT_GT(onRoad, 200);
}

TEST(GroundCover, strokesWithoutWidthOrLengthAreRefused) {
  GroundCover cover(20, kGrass);
  EXPECT_THROW(cover.paintDisk(kRoad, {0, 0}, 0), std::invalid_argument);
  EXPECT_THROW(cover.paintBand(kRoad, {1, 1}, {1, 1}, 2), std::invalid_argument);
}

}  // namespace
