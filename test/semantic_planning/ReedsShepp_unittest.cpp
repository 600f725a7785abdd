#include <gtest/gtest.h>
#include <semantic_planning/vehicle/ReedsShepp.h>

#include <cmath>
#include <random>

using mrpt::math::TPose2D;
using semantic_planning::CurvePoint;
using semantic_planning::ReedsShepp;
using semantic_planning::ReedsSheppCurve;

namespace {

class RandomPoses {
 public:
  TPose2D operator()() { return {m_at(m_random), m_at(m_random), m_heading(m_random)}; }

 private:
  std::mt19937 m_random{7};
  std::uniform_real_distribution<double> m_at{-8, 8}, m_heading{-M_PI, M_PI};
};

void expectSame(const TPose2D& a, const TPose2D& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(std::remainder(a.phi - b.phi, 2 * M_PI), 0, tolerance);
}

}  // namespace

TEST(ReedsShepp, theReversedCurveGoesThroughTheSamePosesInTheOtherGear) {
  const ReedsShepp shepp(1.2);
  RandomPoses pose;
  for (int i = 0; i < 200; ++i) {
    const ReedsSheppCurve curve = shepp.connect(pose(), pose());
    const ReedsSheppCurve back = curve.reversed();
    EXPECT_NEAR(back.length(), curve.length(), 1e-9);
    for (double t = 0.013; t < 1; t += 0.1) {
      const CurvePoint p = curve.at(t * curve.length()), q = back.at((1 - t) * curve.length());
      expectSame(p.pose, q.pose, 1e-6);
      EXPECT_NE(p.forward, q.forward);
      EXPECT_DOUBLE_EQ(p.curvature, q.curvature);
    }
  }
}

TEST(ReedsShepp, poseAndCurvatureAgreeAlongTheCurve) {
  const ReedsShepp shepp(2);
  RandomPoses pose;
  for (int i = 0; i < 200; ++i) {
    const ReedsSheppCurve curve = shepp.connect(pose(), pose());
    const double h = 1e-5;
    for (double s = 0.0137; s + h < curve.length(); s += 0.31) {
      const CurvePoint p = curve.at(s), q = curve.at(s + h);
      if (p.forward != q.forward || p.curvature != q.curvature) continue;
      const double gear = p.forward ? 1 : -1;
      EXPECT_NEAR((q.pose.x - p.pose.x) / h, gear * std::cos(p.pose.phi), 1e-4);
      EXPECT_NEAR((q.pose.y - p.pose.y) / h, gear * std::sin(p.pose.phi), 1e-4);
      EXPECT_NEAR(std::remainder(q.pose.phi - p.pose.phi, 2 * M_PI) / h, gear * p.curvature, 1e-4);
    }
  }
}

TEST(ReedsShepp, theLowerBoundIsOneAndTheDistanceIsSymmetric) {
  const ReedsShepp shepp(1);
  RandomPoses pose;
  for (int i = 0; i < 5000; ++i) {
    const TPose2D a = pose(), b = pose();
    EXPECT_LE(shepp.lowerBound(a, b), shepp.distance(a, b) + 1e-9);
    EXPECT_NEAR(shepp.distance(a, b), shepp.distance(b, a), 1e-9);
  }
}

TEST(ReedsShepp, refusesARadiusThatIsNotPositive) {
  for (const double radius : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(ReedsShepp{radius}, std::invalid_argument) << radius;
}
