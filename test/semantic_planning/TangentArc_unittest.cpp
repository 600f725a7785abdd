#include "planner/PathSmoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace semantic_planning;
using mrpt::math::TPose2D;

namespace {

/** How far apart two poses are, meters and radians. */
double gap(const TPose2D& a, const TPose2D& b) {
  return std::hypot(b.x - a.x, b.y - a.y) + std::abs(std::remainder(b.phi - a.phi, 2 * M_PI));
}

/** Where driving in steps of equal length leads: knows no circles. */
TPose2D driven(TPose2D p, double curvature, double length) {
  constexpr int kSteps = 20000;
  const double step = length / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = p.phi + curvature * step / 2;
    p = {p.x + step * std::cos(middle), p.y + step * std::sin(middle), p.phi + curvature * step};
  }
  return p;
}

}  // namespace

TEST(TangentArc, anArcLeadsWhereDrivingInSmallStepsDoes) {
  for (const double curvature : {-1.0, -0.05, 0.0, 0.3, 2.0})
    for (const double length : {0.2, 3.0, 9.0}) {
      const TPose2D begin(3, -2, 2.5);
      EXPECT_LT(gap(Arc{begin, curvature, 0}.at(length), driven(begin, curvature, length)), 1e-5);
    }
}

TEST(TangentArc, aQuarterOfACircleJoinsLinesThatCross) {
  const auto found = tangentArc({0, 0, 0}, {{5, 7, M_PI / 2}, 0, 1});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->arc.curvature, 0.2, 1e-12);
  EXPECT_NEAR(found->arc.length, 5 * M_PI / 2, 1e-9);
  EXPECT_NEAR(found->meets, -2, 1e-9);
}

TEST(TangentArc, aStraightWayIsFoundWhereItIsTangent) {
  const auto found = tangentArc({-4, 2, 0}, {{0, 2, 0}, -0.5, 3});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->arc.curvature, 0);
  EXPECT_NEAR(found->arc.length, 4, 1e-9);
  EXPECT_NEAR(found->meets, 0, 1e-9);
}

TEST(TangentArc, anArcEndsOnTheOtherAndInItsDirection) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-10, 10), angle(-M_PI, M_PI), bend(-1, 1);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const TPose2D from(place(random), place(random), angle(random));
    const Arc into{{place(random), place(random), angle(random)}, i % 3 ? bend(random) : 0, 1};
    const auto tangent = tangentArc(from, into);
    if (!tangent) continue;
    ++found;
    EXPECT_LT(gap(tangent->arc.begin, from), 1e-12);
    EXPECT_GT(tangent->arc.length, 0);
    EXPECT_LT(gap(tangent->arc.at(tangent->arc.length), into.at(tangent->meets)), 1e-5);
  }
  EXPECT_GT(found, 600);
}
