// What curves and paths cost their vehicle.
#include <gtest/gtest.h>
#include <semantic_planning/vehicle/MotionCost.h>

#include <random>

using namespace semantic_planning;
using mrpt::math::TPose2D;

TEST(MotionCost, aPathCostsWhatItsCurveDoes) {
  VehicleOptions vehicle;
  vehicle.reverseWeight = 3;
  vehicle.gearChange = 2;
  vehicle.steeringChange = 0.5;
  const MotionCost price(vehicle);
  const ReedsSheppCurve there({0, 0, 0}, 1, {{{2, 0}, {1, 1}, {-1.5, 0}, {-1, -1}, {0, 0}}});
  EXPECT_NEAR(price.of(there), 3 + 3 * 2.5 + 2 + 0.5 + 0.5 + 0.5, 1e-9);
  EXPECT_NEAR(price.of(there.reversed()), 2.5 + 3 * 3 + 2 + 0.5 + 0.5 + 0.5, 1e-9);
  std::vector<PathPoint> path;
  for (double s = 0; s <= there.length() + 1e-9; s += 0.05) {
    const CurvePoint at = there.at(s);
    PathPoint p;
    p.curvature = at.curvature, p.forward = at.forward, p.arcLength = s;
    path.push_back(p);
  }
  EXPECT_NEAR(price.of(path), price.of(there), 0.25);
}

TEST(MotionCost, knowsOnlyForwardCurvesOfAVehicleThatOnlyDrivesForward) {
  VehicleOptions vehicle;
  vehicle.reverseWeight = std::numeric_limits<double>::infinity();
  const MotionCost price(vehicle);
  EXPECT_FALSE(price.canReverse());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-6, 6), heading(-M_PI, M_PI);
  const auto draw = [&] { return TPose2D(at(random), at(random), heading(random)); };
  for (int i = 0; i < 100; ++i)
    for (const ReedsSheppCurve& curve : price.curves(draw(), draw()))
      for (const auto& segment : curve.segments()) EXPECT_GE(segment.length, 0);
}
