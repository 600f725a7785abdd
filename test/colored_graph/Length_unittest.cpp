#include <colored_graph/Edge.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

using namespace colored_graph;

TEST(Length, roundsEdgesUpAndBoundsDown) {
  EXPECT_EQ(lengthUp(0.00011), 2);
  EXPECT_EQ(lengthDown(0.00019), 1);
  EXPECT_EQ(lengthUp(0), 0);
  EXPECT_EQ(lengthDown(0), 0);
  EXPECT_DOUBLE_EQ(toMeters(12345), 1.2345);
}

TEST(Length, roundingNoiseAtAWholeUnitDoesNotCount) {
  EXPECT_EQ(lengthUp(0.1 + 0.2), 3000);    // 0.30000000000000004
  EXPECT_EQ(lengthDown(0.8 - 0.5), 3000);  // 0.30000000000000004
  EXPECT_EQ(lengthDown(0.9 - 0.6), 3000);  // 0.30000000000000004 or 0.29999999999999998
  EXPECT_EQ(lengthDown(0.4 - 0.1), 3000);
  EXPECT_EQ(lengthDown(1.1 - 0.8), 3000);
}

TEST(Length, roundedLinesKeepTheTriangleInequality) {
  EXPECT_TRUE(rc::check([] {
    const auto coordinate = [] { return *rc::gen::inRange(-3000, 3000) * 0.1; };
    const double ax = coordinate(), ay = coordinate(), bx = coordinate(), by = coordinate();
    const double t = *rc::gen::inRange(-10, 20) * 0.1;  // c on the line through a and b
    const double cx = ax + t * (bx - ax), cy = ay + t * (by - ay);
    const double ab = std::hypot(ax - bx, ay - by), bc = std::hypot(bx - cx, by - cy),
                 ac = std::hypot(ax - cx, ay - cy);
    RC_ASSERT(lengthDown(ac) <= lengthUp(ab) + lengthDown(bc));
    RC_ASSERT(lengthDown(bc) <= lengthUp(ab) + lengthDown(ac));
  }));
}

TEST(Length, refusesWhatIsNoLength) {
  for (const double meters :
       {-1e-9, -1.0, std::nan(""), 1e15, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(lengthUp(meters), std::invalid_argument) << meters;
    EXPECT_THROW(lengthDown(meters), std::invalid_argument) << meters;
  }
}
