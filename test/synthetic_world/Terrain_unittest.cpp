#include <gtest/gtest.h>
#include <synthetic_world/Objects.h>
#include <synthetic_world/World.h>

#include <Eigen/Geometry>

#include "SmallWorld.h"

namespace {

using synthetic_world::Random;
using synthetic_world::Terrain;

const std::vector<Terrain::Wave> kHills{{2, 40, 0.3, 1}, {0.7, 15, 2.0, 0.2}};

TEST(Terrain, followsItsWaves) {
  const Terrain terrain(40, kHills);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-40, 40), y = random.uniform(-40, 40);
    double expected = 0;
    for (const auto& w : kHills)
      expected +=
          w.amplitude *
          std::sin(2 * M_PI / w.length * (x * std::cos(w.direction) + y * std::sin(w.direction)) +
                   w.phase);
    EXPECT_NEAR(terrain.height(x, y), expected, 0.05);
  }
}

TEST(Terrain, beyondTheEdgeTheEdgesHeightGoesOn) {
  const Terrain terrain(40, kHills);
  EXPECT_EQ(terrain.height(95, 7), terrain.height(40, 7));
  EXPECT_EQ(terrain.height(3, -41), terrain.height(3, -40));
}

TEST(Terrain, normalStandsUprightOnTheSlope) {
  const Terrain flat(10, {});
  EXPECT_EQ(flat.normal(1, 2), Eigen::Vector3d::UnitZ());
  const Terrain terrain(40, kHills);
  const Eigen::Vector3d n = terrain.normal(5.5, -3.5);
  const Eigen::Vector3d alongX(0.5, 0, terrain.height(5.75, -3.5) - terrain.height(5.25, -3.5));
  EXPECT_NEAR(n.dot(alongX), 0, 1e-12);
  EXPECT_NEAR(n.norm(), 1, 1e-12);
}

TEST(Terrain, raysEnterACellWhereMarchingFindsTheGround) {
  const Terrain terrain(40, kHills);
  Random random(5);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d target(random.uniform(10, 11), random.uniform(-7, -6), 0);
    const Eigen::Vector3d o =
        target + Eigen::Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), 4);
    const Eigen::Vector3d d =
        (target + Eigen::Vector3d(0, 0, random.uniform(-3, 3)) - o).normalized();
    const auto entry = terrain.enter(50, 33, o, d, 0, 8);
    if (!entry) continue;
    const Eigen::Vector3d p = o + *entry * d;
    if (p.x() < 10 || p.x() > 11 || p.y() < -7 || p.y() > -6)
      continue;  // the cell's surface goes on
    ++met;
    EXPECT_NEAR(p.z(), terrain.height(p.x(), p.y()), 1e-9);
  }
  EXPECT_GT(met, 300);
}

TEST(Terrain, refusesBadInput) {
  EXPECT_EQ(errorOf([] { Terrain(0, {}); }), "terrain: halfExtent is 0, 1 to 1000 m expected");
  EXPECT_EQ(errorOf([] {
              Terrain(10, {{1, 4, 0, 0}});
            }),
            "terrain: a wave of 4.000000 m, 8 m or more expected");
  EXPECT_EQ(errorOf([] { Terrain(10, {{NAN, 40, 0, 0}}); }), "terrain: a wave is not finite");
}

}  // namespace
