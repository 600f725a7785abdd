#include <gtest/gtest.h>
#include <synthetic_world/World.h>

#include <cmath>

#include "SmallWorld.h"

namespace {

using synthetic_world::Curve;
using V2 = Eigen::Vector2d;

const std::vector<V2> kRing{{-20, -10}, {25, -14}, {30, 12}, {0, 20}, {-22, 14}};

TEST(Curve, roundedSquareHasTheLengthOfItsStraightsAndArcs) {
  const Curve curve({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 2, true);
  EXPECT_NEAR(curve.length(), 4 * 6 + 2 * M_PI * 2, 1e-12);
}

TEST(Curve, headingIsTheDirectionOfMotionAndHasNoKink) {
  const Curve curve(kRing, 6, true);
  const double h = 1e-5;
  for (double s = 0; s < curve.length(); s += 0.37) {
    const V2 moved = (curve.at(s + h) - curve.at(s - h)) / (2 * h);
    EXPECT_NEAR(moved.norm(), 1, 1e-5) << s;
    EXPECT_NEAR(moved.x(), std::cos(curve.heading(s)), 1e-4) << s;
    EXPECT_NEAR(moved.y(), std::sin(curve.heading(s)), 1e-4) << s;
  }
}

TEST(Curve, closedCurveWrapsAroundAndOpenOneStops) {
  const Curve ring(kRing, 6, true), open(kRing, 6);
  EXPECT_NEAR((ring.at(3) - ring.at(3 + ring.length())).norm(), 0, 1e-9);
  EXPECT_NEAR((ring.at(-2) - ring.at(ring.length() - 2)).norm(), 0, 1e-9);
  EXPECT_EQ(open.at(-5), kRing.front());
  EXPECT_NEAR((open.at(1e6) - kRing.back()).norm(), 0, 1e-9);
}

TEST(Curve, parallelKeepsItsDistanceOnTheAskedSide) {
  const Curve curve(kRing, 6, true);
  for (const double left : {-3.0, 2.5}) {
    const Curve parallel = curve.parallel(left);
    for (double s = 0; s < parallel.length(); s += 1.3) {
      double least = 1e9;
      for (double t = 0; t < curve.length(); t += 0.01)
        least = std::min(least, (curve.at(t) - parallel.at(s)).norm());
      EXPECT_NEAR(least, std::abs(left), 1e-4);
    }
    EXPECT_EQ(parallel.length() < curve.length(), left > 0);  // the ring turns left
  }
}

TEST(Curve, refusesBadInput) {
  EXPECT_EQ(errorOf([] { Curve({{0, 0}}, 1); }), "curve: 1 corners, at least 2 expected");
  EXPECT_EQ(errorOf([] {
              Curve({{0, 0}, {1, 0}}, 1, true);
            }),
            "curve: 2 corners, at least 3 expected");
  EXPECT_EQ(errorOf([] { Curve({{0, 0}, {1, 0}}, 0); }), "curve: the radius must be positive");
  EXPECT_EQ(errorOf([] {
              Curve({{0, 0}, {2, 1}, {2, 1}}, 1);
            }),
            "curve: corner 1 equals the next one");
  EXPECT_EQ(errorOf([] {
              Curve({{0, 0}, {5, 0}, {1, 0}}, 1);
            }),
            "curve: a corner turns back on itself");
  EXPECT_EQ(errorOf([] { Curve(kRing, 6, true).parallel(7); }),
            "curve: too narrow for this parallel");
}

}  // namespace
