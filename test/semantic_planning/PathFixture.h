#pragma once
#include <optional>
#include <vector>

#include "PlannerFixture.h"
#include "planner/PathImprovement.h"

/** Paths along given stretches in a painted world, and who checks their curves. */
class PathTest : public PlannerTest {
 protected:
  using PathPoint = semantic_planning::PathPoint;
  using Segments = std::vector<semantic_planning::ReedsSheppCurve::Segment>;

  const semantic_planning::CollisionChecker& checker() {
    if (!m_ground) {
      m_ground.emplace(map(), options.vehicle, options.ground, order);
      m_checker.emplace(*m_ground, options.vehicle, order);
    }
    return *m_checker;
  }
  /** After something was painted. */
  void readGroundAgain() {
    m_checker.reset();
    m_ground.reset();
  }
  std::vector<PathPoint> drive(const TPose2D& from, const Segments& segments) {
    std::vector<PathPoint> path;
    semantic_planning::GroundPose at = *checker().place(from);
    for (const auto& segment : segments) {
      const semantic_planning::ReedsSheppCurve curve(at.pose, options.vehicle.turningRadius,
                                                     {{segment}});
      appendCurve(checker().trace(curve, at.z), path);
      at.pose = curve.at(curve.length()).pose;
    }
    return path;
  }
  static void expectSameEnds(const std::vector<PathPoint>& path,
                             const std::vector<PathPoint>& other) {
    EXPECT_NEAR(path.front().x, other.front().x, 1e-6);
    EXPECT_NEAR(path.front().y, other.front().y, 1e-6);
    EXPECT_NEAR(std::remainder(path.front().heading - other.front().heading, 2 * M_PI), 0, 1e-4);
    EXPECT_NEAR(path.back().x, other.back().x, 1e-4);
    EXPECT_NEAR(path.back().y, other.back().y, 1e-4);
    EXPECT_NEAR(std::remainder(path.back().heading - other.back().heading, 2 * M_PI), 0, 1e-4);
  }

 private:
  std::optional<semantic_planning::Ground> m_ground;
  std::optional<semantic_planning::CollisionChecker> m_checker;
};
