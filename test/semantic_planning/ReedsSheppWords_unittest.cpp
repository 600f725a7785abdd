#include <gtest/gtest.h>
#include <semantic_planning/vehicle/ReedsShepp.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#if __has_include(<ompl/base/spaces/ReedsSheppStateSpace.h>)  // Debian testing has no OMPL
#define MSO_OMPL
#include "ReedsSheppOracle.h"
#endif

using mrpt::math::TPose2D;
using semantic_planning::CurvePoint;
using semantic_planning::ReedsShepp;
using semantic_planning::ReedsSheppCurve;

namespace {

using Pair = std::pair<TPose2D, TPose2D>;
using Frame = TPose2D;  // where a pose is seen from

TPose2D composed(const Frame& frame, const TPose2D& pose) {
  const double c = std::cos(frame.phi), s = std::sin(frame.phi);
  return {frame.x + c * pose.x - s * pose.y, frame.y + s * pose.x + c * pose.y,
          std::remainder(frame.phi + pose.phi, 2 * M_PI)};
}

/** Drives the segments one after the other, seen from the start. */
TPose2D endOf(const ReedsSheppCurve& curve, const TPose2D& from, double radius) {
  TPose2D pose = from;
  for (const auto& [length, turn] : curve.segments()) {
    const double angle = length / radius;
    pose = composed(pose, turn == 0 ? TPose2D{length, 0, 0}
                                    : TPose2D{radius * std::sin(angle),
                                              turn * radius * (1 - std::cos(angle)), turn * angle});
  }
  return pose;
}

double gap(const TPose2D& a, const TPose2D& b) {
  return std::max(std::hypot(a.x - b.x, a.y - b.y),
                  std::abs(std::remainder(a.phi - b.phi, 2 * M_PI)));
}

class Draws {
 public:
  double within(double most) {
    return std::uniform_real_distribution<double>(-most, most)(m_random);
  }
  double heading() { return within(M_PI); }
  /** One of the multiples up to `most`. */
  double snapped(double step, int most) {
    return step * std::uniform_int_distribution<int>(-most, most)(m_random);
  }
  TPose2D pose(double box) { return {within(box), within(box), heading()}; }
  Pair pair(double box) { return {pose(box), pose(box)}; }
  Pair offset(const TPose2D& goal) {
    const TPose2D from = pose(5);
    return {from, composed(from, goal)};
  }

 private:
  std::mt19937 m_random{11};
};

using Pairs = std::vector<Pair>;

/** In boxes from far below to far above the turning radius. */
Pairs randomPairs(int each, double radius) {
  Draws draw;
  Pairs pairs;
  for (const double box : {0.003, 0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 1000.0})
    for (int i = 0; i < each; ++i) pairs.push_back(draw.pair(box * radius));
  return pairs;
}

/** Goals where words merge, vanish or tie, for a radius of 1. */
Pairs degeneratePairs(int each) {
  Draws draw;
  Pairs pairs;
  const auto add = [&](const TPose2D& goal) { pairs.push_back(draw.offset(goal)); };
  const auto onGrid = [&]() {
    return TPose2D{draw.snapped(1, 4), draw.snapped(1, 4), draw.snapped(M_PI / 2, 3)};
  };
  for (int i = 0; i < each; ++i) {
    add({0, 0, 0});
    add({draw.within(4), 0, 0});
    add({0, draw.within(4), 0});
    add({0, 0, draw.heading()});
    add({draw.within(5), 0, draw.heading()});
    add({draw.within(5), draw.within(5), M_PI});
    add({draw.within(5), draw.within(5), 0});
    add({draw.within(1e-7), draw.within(1e-7), draw.within(1e-7)});
    add({draw.within(1e5), draw.within(1e5), draw.heading()});
    const double turn = draw.heading();  // one arc alone
    add({std::sin(turn), 1 - std::cos(turn), turn});
    const TPose2D pose = draw.pose(3);
    pairs.push_back({pose, {pose.x, pose.y, pose.phi + draw.snapped(2 * M_PI, 2)}});
    pairs.push_back({onGrid(), onGrid()});
  }
  return pairs;
}

int used(const ReedsSheppCurve& curve) {
  return static_cast<int>(std::count_if(curve.segments().begin(), curve.segments().end(),
                                        [](const auto& segment) { return segment.length != 0; }));
}

}  // namespace

#ifdef MSO_OMPL
TEST(ReedsSheppWords, areAsLongAsThoseOfOmpl) {
  for (const double radius : {0.4, 1.0, 5.0}) {
    const ReedsShepp shepp(radius);
    const ReedsSheppOracle ompl(radius);
    for (const auto& [a, b] : randomPairs(4000, radius)) {
      const double expected = ompl.distance(a, b);
      ASSERT_NEAR(shepp.distance(a, b), expected, 1e-9 * expected)
          << radius << ": " << a << " to " << b;
    }
  }
}

TEST(ReedsSheppWords, areNowhereLongerThanThoseOfOmpl) {
  const ReedsShepp shepp(1);
  const ReedsSheppOracle ompl(1);
  for (const auto& [a, b] : degeneratePairs(3000)) {
    const double expected = ompl.distance(a, b);
    // The length between poses close to each other is as good as the root of the goal's rounding.
    ASSERT_LE(shepp.distance(a, b), expected + 1e-9 * std::max(0.1, expected)) << a << " to " << b;
  }
}

TEST(ReedsSheppWords, thatOnlyGoForwardAreNowhereLongerThanThoseOfDubins) {
  for (const double radius : {0.4, 1.0, 5.0}) {
    const ReedsShepp shepp(radius);
    const ReedsSheppOracle ompl(radius);
    for (const auto& [a, b] : randomPairs(2000, radius))
      ASSERT_LE(shepp.connectForward(a, b).length(), ompl.forwardDistance(a, b) + 1e-6 * radius)
          << radius << ": " << a << " to " << b;
  }
}
#endif

TEST(ReedsSheppWords, thatOnlyGoForwardLeadToTheGoal) {
  for (const double radius : {0.4, 1.0, 5.0})
    for (const auto& [a, b] : randomPairs(2000, radius)) {
      const ReedsSheppCurve curve = ReedsShepp(radius).connectForward(a, b);
      ASSERT_LT(gap(endOf(curve, a, radius), b), 1e-7) << radius << ": " << a << " to " << b;
      for (const auto& segment : curve.segments()) ASSERT_GE(segment.length, 0);
    }
}

TEST(ReedsSheppWords, leadToTheGoalInTheLengthOfTheDistance) {
  for (const double radius : {0.4, 1.0, 5.0}) {
    const ReedsShepp shepp(radius);
    for (const Pairs& pairs : {randomPairs(1000, radius), degeneratePairs(1000)})
      for (const auto& [a, b] : pairs) {
        const ReedsSheppCurve curve = shepp.connect(a, b);
        double sum = 0;
        for (const auto& segment : curve.segments()) sum += std::abs(segment.length);
        ASSERT_LT(gap(endOf(curve, a, radius), b), 1e-9) << radius << ": " << a << " to " << b;
        ASSERT_DOUBLE_EQ(curve.length(), sum);
        ASSERT_NEAR(sum, shepp.distance(a, b), 1e-9);
        ASSERT_LE(shepp.lowerBound(a, b), sum + 1e-9);
      }
  }
}

TEST(ReedsSheppWords, areAsLongOnTheWayBackToTheBit) {
  const ReedsShepp shepp(1.3);
  for (const Pairs& pairs : {randomPairs(2000, 1.3), degeneratePairs(1000)})
    for (const auto& [a, b] : pairs) ASSERT_EQ(shepp.distance(a, b), shepp.distance(b, a));
}

TEST(ReedsSheppWords, areTheSameOnTheWayBack) {
  const ReedsShepp shepp(1);
  for (const auto& [a, b] : randomPairs(1000, 1)) {
    const auto there = shepp.connect(a, b).segments();
    const auto back = shepp.connect(b, a).reversed().segments();
    for (int i = 0; i < 5; ++i) {
      ASSERT_NEAR(there[i].length, back[i].length, 1e-12) << a << " to " << b;
      if (there[i].length == 0) continue;
      ASSERT_EQ(there[i].turn, back[i].turn) << a << " to " << b;
    }
  }
}

TEST(ReedsSheppWords, ofOneArcAreNothingElse) {
  const ReedsShepp shepp(1);
  Draws draw;
  for (int i = 0; i < 5000; ++i) {
    const double turn = draw.heading();
    const auto [a, b] = draw.offset({std::sin(turn), 1 - std::cos(turn), turn});
    ASSERT_NEAR(shepp.distance(a, b), std::abs(turn), 1e-12) << a << " to " << b;
    ASSERT_EQ(used(shepp.connect(a, b)), 1) << a << " to " << b;
  }
}

TEST(ReedsSheppWords, haveNoMoreSegmentsThanNeeded) {
  const ReedsShepp shepp(1);
  const TPose2D start{2, 1, 0.7};
  const auto segmentsTo = [&](const TPose2D& goal) {
    return used(shepp.connect(start, composed(start, goal)));
  };
  EXPECT_EQ(segmentsTo({0, 0, 0}), 0);
  EXPECT_EQ(segmentsTo({4, 0, 0}), 1);
  EXPECT_EQ(segmentsTo({-4, 0, 0}), 1);
  EXPECT_EQ(segmentsTo({4, 1, M_PI / 2}), 2);
  EXPECT_EQ(segmentsTo({std::sin(1), 1 - std::cos(1), 1}), 1);
}

TEST(ReedsShepp, theReversedCurveGoesThroughTheSamePosesInTheOtherGear) {
  const ReedsShepp shepp(1.2);
  for (const auto& [a, b] : randomPairs(25, 1.2)) {
    const ReedsSheppCurve curve = shepp.connect(a, b), back = curve.reversed();
    EXPECT_NEAR(back.length(), curve.length(), 1e-9);
    for (double t = 0.013; t < 1; t += 0.1) {
      const CurvePoint p = curve.at(t * curve.length()), q = back.at((1 - t) * curve.length());
      EXPECT_LT(gap(p.pose, q.pose), 1e-6);
      EXPECT_NE(p.forward, q.forward);
      EXPECT_DOUBLE_EQ(p.curvature, q.curvature);
    }
  }
}

TEST(ReedsShepp, poseAndCurvatureAgreeAlongTheCurve) {
  const ReedsShepp shepp(2);
  Draws draw;
  for (int i = 0; i < 200; ++i) {
    const auto [a, b] = draw.pair(8);
    const ReedsSheppCurve curve = shepp.connect(a, b);
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

TEST(ReedsShepp, refusesARadiusThatIsNotPositive) {
  for (const double radius : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_THROW(ReedsShepp{radius}, std::invalid_argument) << radius;
}
