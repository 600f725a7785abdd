#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>
#include <synthetic_world/Solids.h>
#include <synthetic_world/World.h>
#include <Eigen/Geometry>

#include <cmath>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using V = Eigen::Vector3d;

const Polygon kOutline = rectangle({0.3, -0.2}, 0.7, 2.4, 1.2);

struct Named {
  const char* name;
  Shape shape;
};
const Named kShapes[] = {
    {"box", Polyhedron(kOutline, kOutline, -0.5, 1)},
    {"stump", Polyhedron(kOutline, rectangle({0.3, -0.2}, 0.7, 1.2, 0.5), -0.5, 1)},
    {"gable", Polyhedron::gable({0.3, -0.2}, 0.7, 2.4, 1.6, -0.5, 1)},
    {"cylinder", Shaft{{0.2, 0.1}, 0.8, 0.8, -1, 1}},
    {"cone", Shaft{{0.2, 0.1}, 1.1, 0, -1, 1}},
    {"funnel", Shaft{{0.2, 0.1}, 0.3, 0.9, -1, 1}},
    {"ball", Spheroid{{0.1, 0.2, 0.3}, 0.9, 0.9}},
    {"spheroid", Spheroid{{0.1, 0.2, 0.3}, 0.8, 1.3}}};

class EveryShape : public testing::TestWithParam<Named> {
 protected:
  double signedDistance(const V& p) const {
    return std::visit([&](const auto& s) { return s.signedDistance(p); }, GetParam().shape);
  }
  std::optional<Entry> enter(const V& o, const V& d) const {
    return std::visit([&](const auto& s) { return s.enter(o, d); }, GetParam().shape);
  }
  std::optional<Section> section(double low, double high) const {
    return std::visit([&](const auto& s) { return s.section(low, high); }, GetParam().shape);
  }
};
INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(kShapes),
                         [](const auto& tested) { return tested.param.name; });

V randomPoint(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach),
          random.uniform(-reach, reach)};
}

/** Range at which small steps along a ray first are inside; the signed distance is the oracle. */
template <class SignedDistance>
std::optional<double> march(const SignedDistance& f, const V& o, const V& d) {
  for (double t = 0; t < 8; t += 0.002)
    if (f(o + t * d) <= 0) return t;
  return std::nullopt;
}

TEST_P(EveryShape, raysEnterWhereMarchingFindsTheInside) {
  Random random(11);
  int entered = 0;
  for (int i = 0; i < 400; ++i) {
    const V o = randomPoint(random, 3), d = (randomPoint(random, 1.2) - o).normalized();
    const auto entry = enter(o, d);
    const auto marched = march([&](const V& p) { return signedDistance(p); }, o, d);
    if (marched) {
      ASSERT_TRUE(entry) << i;
      EXPECT_NEAR(entry->range, *marched, 0.003) << i;
      ++entered;
    } else if (entry) {  // between two steps: it must graze
      EXPECT_GT(signedDistance(o + (entry->range + 0.001) * d), -0.002) << i;
    }
  }
  EXPECT_GT(entered, 100);
}

TEST_P(EveryShape, normalsPointOutward) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const V o = randomPoint(random, 3), d = (randomPoint(random, 0.8) - o).normalized();
    const auto entry = enter(o, d);
    if (!entry || entry->range == 0) continue;
    const V p = o + entry->range * d;
    EXPECT_NEAR(entry->normal.norm(), 1, 1e-9);
    EXPECT_LE(entry->normal.dot(d), 1e-9);
    EXPECT_NEAR(signedDistance(p), 0, 1e-9);
    EXPECT_NEAR(signedDistance(p + 0.01 * entry->normal), 0.01, 2e-4);
  }
}

TEST_P(EveryShape, signedDistanceNeverExceedsTheDistance) {
  // 1-Lipschitz along any line; that of the spheroid is of first order only.
  const double most = std::string(GetParam().name) == "spheroid" ? 1.5 : 1;
  Random random(13);
  for (int i = 0; i < 2000; ++i) {
    const V a = randomPoint(random, 2), b = a + 0.3 * randomPoint(random, 1);
    EXPECT_LE(std::abs(signedDistance(a) - signedDistance(b)), most * (a - b).norm() + 1e-9);
  }
}

TEST_P(EveryShape, sectionHoldsEverythingBetweenItsHeights) {
  Random random(14);
  for (const auto& [low, high] : {std::pair(-0.4, 0.1), std::pair(0.3, 0.9)}) {
    const auto cut = section(low, high);
    ASSERT_TRUE(cut);
    for (int i = 0; i < 3000; ++i) {
      V p = randomPoint(random, 1.6);
      p.z() = random.uniform(low, high);
      if (signedDistance(p) > 0) continue;
      EXPECT_LT(cut->distanceTo(rectangle(p.head<2>(), 0, 1e-6, 1e-6)), 1e-5);
    }
  }
  EXPECT_FALSE(section(2, 3));
  EXPECT_FALSE(section(-3, -2));
}

TEST(Shapes, sectionsOfRoundShapesAreTight) {
  const Spheroid ball{{0, 0, 2}, 1, 1};
  EXPECT_NEAR(ball.section(0, 1.4)->radius, 0.8, 1e-12);  // 3-4-5
  EXPECT_NEAR(ball.section(0, 2.5)->radius, 1, 1e-12);
  const Shaft cone{{0, 0}, 2, 0, 0, 4};
  EXPECT_NEAR(cone.section(1, 9)->radius, 1.5, 1e-12);
}

using synthetic_world::Curve;
using V2 = Eigen::Vector2d;

const std::vector<V2> kRing{{-20, -10}, {25, -14}, {30, 12}, {0, 20}, {-22, 14}};

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

/** The ground along a ray by small steps and bisection; independent of cells. */
std::optional<double> marchedGround(const World& world, const V& o, const V& d, double maxRange) {
  const auto above = [&](double t) {
    const V p = o + t * d;
    return p.z() - world.groundHeight(p.x(), p.y());
  };
  const double step = 0.01;
  for (double t = step; t <= maxRange; t += step) {
    const V p = o + t * d;
    if (!world.terrain().contains(p.x(), p.y())) return std::nullopt;
    if (above(t) > 0) continue;
    double low = t - step, high = t;
    for (int i = 0; i < 40; ++i) (above((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    return high;
  }
  return std::nullopt;
}

struct Brute {
  double range;
  ClassId id;
};

std::optional<Brute> bruteForce(const World& world, const V& o, const V& d, double maxRange) {
  std::optional<Brute> best;
  if (const auto t = marchedGround(world, o, d, maxRange)) {
    const V p = o + *t * d;
    best = Brute{*t, world.groundClass(p.x(), p.y())};
  }
  for (const Solid& s : world.solids()) {
    const auto e = s.enter(o, d);
    if (e && e->range <= maxRange && (!best || e->range < best->range))
      best = Brute{e->range, s.materialAt(o + e->range * d, e->face).id};
  }
  return best;
}

class RayCastInEveryScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, RayCastInEveryScene, testing::ValuesIn(sceneNames()),
                         [](const auto& tested) { return tested.param; });

TEST_P(RayCastInEveryScene, findsWhatBruteForceFinds) {
  const Scene scene = makeScene(GetParam(), 5);
  const World& world = scene.world;
  Random random(21);
  int hits = 0, otherClass = 0;
  const int rays = 400;
  for (int i = 0; i < rays; ++i) {
    const Eigen::Vector2d at = scene.route.at(random.uniform(0, scene.route.length()));
    const V o(at.x(), at.y(), world.groundHeight(at.x(), at.y()) + random.uniform(0.3, 3));
    const double azimuth = random.uniform(-M_PI, M_PI), z = random.uniform(-0.35, 0.25);
    const V d = V(std::cos(azimuth), std::sin(azimuth), z).normalized();
    const auto hit = world.castRay(o, d, 60);
    const auto brute = bruteForce(world, o, d, 60);
    ASSERT_EQ(hit.has_value(), brute.has_value()) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->range, brute->range, 1e-6) << i;
    EXPECT_NEAR((o + hit->range * d - hit->point).norm(), 0, 1e-9);
    otherClass += hit->material.id != brute->id;
  }
  EXPECT_GT(hits, rays / 2);
  EXPECT_EQ(otherClass, 0);
}

TEST(RayCast, axisParallelRaysMeetTheWallAndTheGround) {
  const World world = small_world::withWall();
  const auto wall = world.castRay({0, 0, 1}, V::UnitX(), 100);
  ASSERT_TRUE(wall);
  EXPECT_DOUBLE_EQ(wall->range, 5);
  EXPECT_EQ(wall->material.id, kWall);
  EXPECT_EQ(wall->normal, V(-1, 0, 0));
  const auto ground = world.castRay({0, 0, 1}, -V::UnitZ(), 100);
  ASSERT_TRUE(ground);
  EXPECT_DOUBLE_EQ(ground->range, 1);
  EXPECT_EQ(world.castRay({5.5, 0, 20}, -V::UnitZ(), 100)->material.id, kRoof);
  EXPECT_FALSE(world.castRay({0, 0, 1}, V::UnitZ(), 100));
  EXPECT_FALSE(world.castRay({0, 0, 1}, -V::UnitX(), 100));  // out over the edge
}

TEST(RayCast, raysAlongCellBordersMissNothing) {
  const World world = small_world::withWall();
  for (int y = -15; y <= 15; ++y) {
    const auto hit = world.castRay({-20, double(y), 1}, V::UnitX(), 100);
    ASSERT_TRUE(hit) << y;
    EXPECT_DOUBLE_EQ(hit->range, 25);
    const V diagonal = V(1, 1, 0).normalized();
    ASSERT_TRUE(world.castRay({-10, double(y - 15), 1}, diagonal, 100)) << y;
  }
}

TEST(RayCast, raysFromOutsideTheWorldEnterIt) {
  const World world = small_world::withWall();
  const auto hit = world.castRay({-50, 0, 1}, V::UnitX(), 100);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range, 55);
  EXPECT_FALSE(world.castRay({-50, 0, 1}, -V::UnitX(), 100));
}

TEST(RayCast, raysFromInsideASolidOrTheGroundHitAtOnce) {
  const World world = small_world::withWall();
  EXPECT_EQ(world.castRay({5.5, 0, 1}, V::UnitX(), 10)->range, 0);
  EXPECT_EQ(world.castRay({0, 0, -0.5}, V::UnitX(), 10)->range, 0);
}

TEST(RayCast, movablesAreMetToo) {
  World world = small_world::withWall();
  world.setMovables({small_world::box({3, 0}, {1, 1}, 0, 2, kPerson, kPerson)});
  EXPECT_EQ(world.castRay({0, 0, 1}, V::UnitX(), 10)->material.id, kPerson);
  world.setMovables({});
  EXPECT_EQ(world.castRay({0, 0, 1}, V::UnitX(), 10)->material.id, kWall);
}

}  // namespace
