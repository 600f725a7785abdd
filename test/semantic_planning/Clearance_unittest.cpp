#include <gtest/gtest.h>
#include <semantic_planning/ground/Ground.h>

#include <cmath>
#include <random>

#include "PaintedGround.h"

using namespace semantic_planning;
using painted_ground::kOrigin;

namespace {

constexpr int kHalf = 40;  // columns of the world to each side

/** Looks at every surface and every column around it, by the definition alone. */
class ClearanceOracle {
 public:
  ClearanceOracle(const Ground& ground, const VehicleOptions& vehicle,
                  const colored_graph::ClassOrder& order)
      : m_ground(ground),
        m_order(order),
        m_height(int(std::lround(vehicle.height / ground.voxelSize()))),
        m_rise(std::tan(vehicle.maxSlope * M_PI / 180)) {}

  int clearance2(Column c, const Surface& s) const {
    const int farthest = m_ground.largestClearance();
    int clearance2 = farthest * farthest;
    for (int y = -farthest; y <= farthest; ++y)
      for (int x = -farthest; x <= farthest; ++x) {
        const int dx = std::max(0, std::abs(x) - 1), dy = std::max(0, std::abs(y) - 1);
        const int tolerance =
            std::min(m_height, 2 * m_ground.step() + 1 + int(m_rise * (std::max(dx, dy) + 1)));
        if (isObstacle({c.x + x, c.y + y}, s.z, tolerance))
          clearance2 = std::min(clearance2, dx * dx + dy * dy);
      }
    return clearance2;
  }

 private:
  bool isFree(const Surface& s) const {
    return s.drivable && m_order.rank(s.classId) != colored_graph::kForbidden;
  }

  /** At about a height: something that is not free, or nothing next to something free. */
  bool isObstacle(Column c, int z, int tolerance) const {
    for (const Surface& s : m_ground.surfaces(c))
      if (!isFree(s) && std::abs(s.z - z) <= tolerance) return true;
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        for (const Surface& s : m_ground.surfaces({c.x + x, c.y + y}))
          if (isFree(s) && std::abs(s.z - z) <= tolerance &&
              !m_ground.near(c, s.z, m_ground.step()))
            return true;
    return false;
  }

  const Ground& m_ground;
  const colored_graph::ClassOrder& m_order;
  int m_height;
  double m_rise;
};

/** A hillside with boxes, trees, holes, and a slab above a part of it. */
void paintHillside(PaintedWorld& world, unsigned seed) {
  std::mt19937 random(seed);
  const auto height = [](int x, int y) {
    return int(std::lround(0.2 * x + 2 * std::sin(y / 9.0)));
  };
  for (int x = -kHalf; x < kHalf; ++x)
    for (int y = -kHalf; y < kHalf; ++y) {
      if (random() % 50 == 0) continue;
      world.voxel(x, y, height(x, y), random() % 60 == 0 ? PaintedWorld::Mud : PaintedWorld::Road);
      if (x > 15 && y > 10) world.voxel(x, y, height(x, y) + 7, PaintedWorld::Grass);
    }
  for (int i = 0; i < 25; ++i) {
    const int x = int(random() % 70) - 35, y = int(random() % 70) - 35, edge = int(random() % 4);
    for (int u = x; u <= x + edge; ++u)
      for (int v = y; v <= y + edge; ++v)
        for (int z = 0; z < 4; ++z) world.voxel(u, v, height(x, y) + z, PaintedWorld::Wall);
  }
}

}  // namespace

TEST(Clearance, isThatOfBruteForceOnAHillsideWithLevelsHolesAndForbiddenGround) {
  const colored_graph::ClassOrder order(5, {{1}, {2}, {3}, {0}});  // mud is forbidden
  VehicleOptions vehicle;
  vehicle.clearance = 0.5;
  GroundOptions options;
  options.keepOff = true;
  options.unknownGap = 1;
  for (const unsigned seed : {1u, 2u, 3u}) {
    PaintedWorld world;
    paintHillside(world, seed);
    const Ground ground(world.map({0.05, 0.05, 20}), vehicle, options, order);
    const ClearanceOracle oracle(ground, vehicle, order);
    std::vector<int> found(ground.largestClearance() * ground.largestClearance() + 1);
    for (int x = -kHalf - 1; x <= kHalf; ++x)
      for (int y = -kHalf - 1; y <= kHalf; ++y)
        for (const Surface& s : ground.surfaces({kOrigin + x, kOrigin + y})) {
          ASSERT_EQ(s.clearance2, oracle.clearance2({kOrigin + x, kOrigin + y}, s))
              << x << ' ' << y << ' ' << s.z;
          ++found[s.clearance2];
        }
    for (const int clearance2 : {0, 1, 4, int(found.size()) - 1})
      EXPECT_GT(found[clearance2], 20) << clearance2;
  }
}
