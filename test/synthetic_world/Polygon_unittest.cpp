#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Solids.h>

#include <cmath>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using V2 = Eigen::Vector2d;

Polygon randomRectangle(Random& random) {
  return rectangle({random.uniform(-3, 3), random.uniform(-3, 3)}, random.uniform(-4, 4),
                   random.uniform(0.5, 4), random.uniform(0.5, 3));
}

/** Points that fill a rectangle (its first corner, along two edges). */
std::vector<V2> filling(const Polygon& r) {
  std::vector<V2> points;
  for (int i = 0; i <= 40; ++i)
    for (int j = 0; j <= 40; ++j)
      points.push_back(r[0] + (r[1] - r[0]) * i / 40.0 + (r[3] - r[0]) * j / 40.0);
  return points;
}

TEST(Polygon, distancesEqualThoseOfDenseSamples) {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const Polygon a = randomRectangle(random), b = randomRectangle(random);
    double least = 1e9;
    for (const V2& p : filling(b)) least = std::min(least, distance(a, p));
    EXPECT_NEAR(distance(a, b), least, 0.06) << trial;
    EXPECT_LE(distance(a, b), least + 1e-12);
    EXPECT_NEAR(distance(a, b), distance(b, a), 1e-12);

    const V2 q(random.uniform(-5, 5), random.uniform(-5, 5));
    double toPoint = 1e9;
    for (const V2& p : filling(a)) toPoint = std::min(toPoint, (p - q).norm());
    EXPECT_NEAR(distance(a, q), toPoint, 0.08) << trial;
  }
}

TEST(Polygon, distanceIsZeroInsideAndWhereOneHoldsTheOther) {
  const Polygon big = rectangle({0, 0}, 0.3, 4, 3), small = rectangle({0.2, 0.1}, 1.0, 1, 0.5);
  EXPECT_EQ(distance(big, V2(0.3, 0.3)), 0);
  EXPECT_EQ(distance(big, small), 0);
  EXPECT_EQ(distance(small, big), 0);
}

TEST(Polygon, whatIsNotConvexIsRefusedByName) {
  const Polygon clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}},
      dented{{0, 0}, {2, 0}, {0.2, 0.2}, {0, 2}};
  const Polygon line{{0, 0}, {1, 0}};
  const Polygon star{{1, 0}, {-0.8, 0.6}, {0.3, -0.95}, {0.3, 0.95}, {-0.8, -0.6}};
  for (const Polygon& p : {clockwise, dented, line, star})
    EXPECT_EQ(errorOf([&] { requireConvex(p, "robot"); }),
              "robot: three or more corners, convex, counterclockwise expected");
}

}  // namespace
