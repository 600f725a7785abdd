// Curves that only go forward, and what curves cost their vehicle.
#include <gtest/gtest.h>
#include <semantic_planning/vehicle/MotionCost.h>

#include <cmath>
#include <random>

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

class ForwardCurves : public testing::Test {
 protected:
  TPose2D draw() { return {m_at(m_random), m_at(m_random), m_heading(m_random)}; }

 private:
  std::mt19937 m_random{7};
  std::uniform_real_distribution<double> m_at{-6, 6}, m_heading{-M_PI, M_PI};
};

}  // namespace

TEST_F(ForwardCurves, leadToTheirGoalsAndOnlyForward) {
  const ReedsShepp shepp(1.3);
  for (int i = 0; i < 20000; ++i) {
    const TPose2D a = draw(), b = draw();
    const ReedsSheppCurve curve = shepp.connectForward(a, b);
    const TPose2D end = curve.at(curve.length()).pose;
    ASSERT_NEAR(end.x, b.x, 1e-7);
    ASSERT_NEAR(end.y, b.y, 1e-7);
    ASSERT_NEAR(std::remainder(end.phi - b.phi, 2 * M_PI), 0, 1e-7);
    for (const auto& segment : curve.segments()) ASSERT_GE(segment.length, 0);
    ASSERT_GE(curve.length(), shepp.distance(a, b) - 1e-9);
  }
}

TEST_F(ForwardCurves, aPathCostsWhatItsCurveDoes) {
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

TEST_F(ForwardCurves, areTheOnlyOnesOfAVehicleThatOnlyDrivesForward) {
  VehicleOptions vehicle;
  vehicle.reverseWeight = std::numeric_limits<double>::infinity();
  const MotionCost price(vehicle);
  EXPECT_FALSE(price.canReverse());
  for (int i = 0; i < 100; ++i)
    for (const ReedsSheppCurve& curve : price.curves(draw(), draw()))
      for (const auto& segment : curve.segments()) EXPECT_GE(segment.length, 0);
}
