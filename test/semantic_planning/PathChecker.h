#pragma once
#include <gtest/gtest.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_planning/planner/PlanResult.h>
#include <semantic_planning/vehicle/VehicleOptions.h>

#include <cmath>

/** Whether a vehicle can drive along a path: looks at the map's voxels and at the path's numbers,
 * nothing else, and in finer steps than the planner. */
class PathChecker {
 public:
  PathChecker(const semantic_octree::SemanticOcTree& map,
              const semantic_planning::VehicleOptions& vehicle)
      : m_map(map), m_vehicle(vehicle), m_voxel(map.getResolution()) {}

  void expectDrivable(const std::vector<semantic_planning::PathPoint>& path) const {
    ASSERT_GE(path.size(), 2u);
    for (std::size_t i = 1; i < path.size(); ++i) {
      expectMotion(path[i - 1], path[i]);
      for (int k = 0; k < 5; ++k) expectFree(between(path[i - 1], path[i], k / 5.0));
      if (testing::Test::HasFailure()) return;  // one is enough
    }
    expectFree(path.back());
  }

 private:
  using PathPoint = semantic_planning::PathPoint;

  static double turn(double from, double to) { return std::remainder(to - from, 2 * M_PI); }

  static PathPoint between(const PathPoint& a, const PathPoint& b, double t) {
    PathPoint p = a;
    p.x += t * (b.x - a.x);
    p.y += t * (b.y - a.y);
    p.z += t * (b.z - a.z);
    p.heading += t * turn(a.heading, b.heading);
    return p;
  }

  /** From one point to the next as wheels roll: along the heading, no tighter than the radius. */
  void expectMotion(const PathPoint& a, const PathPoint& b) const {
    const double step = std::hypot(b.x - a.x, b.y - a.y);
    const double angle = turn(a.heading, b.heading);
    EXPECT_LE(step, 0.5 * m_voxel + 1e-6);
    // An arc is a little longer than its chord.
    EXPECT_LE(std::abs(angle), 1.01 * step / m_vehicle.turningRadius + 1e-3);
    EXPECT_LE(std::abs(b.curvature), 1 / m_vehicle.turningRadius + 1e-9);
    const double middle = a.heading + angle / 2;
    const double sideways = -std::sin(middle) * (b.x - a.x) + std::cos(middle) * (b.y - a.y);
    const double ahead = std::cos(middle) * (b.x - a.x) + std::sin(middle) * (b.y - a.y);
    EXPECT_LE(std::abs(sideways), 0.02 * m_voxel);
    EXPECT_EQ(step <= 1e-6 || (ahead > 0) == b.forward, true);
    const double climb =
        std::max(m_voxel, std::floor(m_vehicle.stepHeight / m_voxel + 1e-6) * m_voxel);
    EXPECT_LE(std::abs(b.z - a.z), climb + 1e-6);
    EXPECT_NEAR(b.arcLength - a.arcLength, step, 0.02 * m_voxel);
  }

  /** No occupied voxel between what the wheels climb and the vehicle's top, under any point of the
   * footprint. */
  void expectFree(const PathPoint& p) const {
    const double c = std::cos(p.heading), s = std::sin(p.heading);
    const auto& polygon = m_vehicle.footprint;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      for (int k = 0; k < 20; ++k)
        for (const double inwards : {0.0, 0.3, 0.6, 0.9}) {
          const Eigen::Vector2d side =
              polygon[i] + k / 20.0 * (polygon[(i + 1) % polygon.size()] - polygon[i]);
          const Eigen::Vector2d q = (1 - inwards) * side;
          expectFreeColumn(p, p.x + c * q.x() - s * q.y(), p.y + s * q.x() + c * q.y(), q.norm());
        }
  }

  void expectFreeColumn(const PathPoint& p, double x, double y, double distance) const {
    const double slope = std::tan(m_vehicle.maxSlope * M_PI / 180) * distance;
    const double climb = std::max(m_voxel, m_vehicle.stepHeight) + slope + m_voxel;
    for (double z = p.z + climb; z < p.z + m_vehicle.height - slope; z += m_voxel / 2)
      ASSERT_FALSE(isOccupied(x, y, z))
          << "at " << x << ' ' << y << ' ' << z << " from " << p.x << ' ' << p.y;
  }

  /** As query() says, without computing all probabilities. */
  bool isOccupied(double x, double y, double z) const {
    octomap::OcTreeKey key;
    if (!m_map.coordToKeyChecked(x, y, z, key)) return false;
    const auto node = m_map.search(key);
    return node && node->getLogOdds() > 0;
  }

  const semantic_octree::SemanticOcTree& m_map;
  const semantic_planning::VehicleOptions& m_vehicle;
  const double m_voxel;
};
