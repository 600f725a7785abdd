#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/Scene.h>

#include "SmallWorld.h"

namespace {

using namespace synthetic_world;
using V = Eigen::Vector3d;

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
  EXPECT_FALSE(wall->onGround);
  const auto ground = world.castRay({0, 0, 1}, -V::UnitZ(), 100);
  ASSERT_TRUE(ground);
  EXPECT_DOUBLE_EQ(ground->range, 1);
  EXPECT_TRUE(ground->onGround);
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
