#pragma once
#include <colored_graph/ColoredAStar.h>
#include <gtest/gtest.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <array>
#include <set>

#include "PaintedWorld.h"
#include "PathChecker.h"

/** A painted world, and a planner for a small robot in it: road is best, then grass, mud, unknown
 * ground; walls are forbidden. */
class PlannerTest : public testing::Test {
 protected:
  using PlanStatus = semantic_planning::PlanStatus;
  using PlanResult = semantic_planning::PlanResult;
  using SemanticPlanner = semantic_planning::SemanticPlanner;
  using TPose2D = mrpt::math::TPose2D;

  PlannerTest() {
    options.roadmap.vertices = 600;
    options.vehicle.footprint = semantic_planning::Footprint::rectangle(-0.2, 0.5, 0.5);
    options.vehicle.wheelTrack = 0.4;
  }

  /** Grass with a road of 3 m along x = -10 and y = 10. */
  void paintCorner() {
    world.floor(-15, 15, -15, 15, PaintedWorld::Grass);
    world.floor(-11.5, -8.5, -15, 11.5, PaintedWorld::Road);
    world.floor(-11.5, 15, 8.5, 11.5, PaintedWorld::Road);
  }

  semantic_octree::SemanticOcTree& map() {
    semantic_octree::SemanticOcTree& m = world.map();
    if (!hasAbstraction(m)) setAbstraction(m, semantic_planning::abstractionFor(order));
    return m;
  }
  SemanticPlanner planner() { return SemanticPlanner(map(), order, options); }
  PlanResult plan() { return planner().plan(start, goal); }

  static double meters(const PlanResult& plan, PaintedWorld::Class id) {
    return plan.lengthPerClass[id];
  }
  /** Length of the part of a path whose points are of a kind. */
  template <typename IsMeant>
  static double meters(const std::vector<semantic_planning::PathPoint>& path,
                       const IsMeant& isMeant) {
    double meters = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
      if (isMeant(path[i])) meters += path[i].arcLength - path[i - 1].arcLength;
    return meters;
  }
  static double metersBackwards(const PlanResult& plan) {
    return meters(plan.path, [](const auto& p) { return !p.forward; });
  }
  static int steeringChanges(const std::vector<semantic_planning::PathPoint>& path) {
    int changes = 0;
    for (std::size_t i = 2; i < path.size(); ++i)
      changes += std::abs(path[i].curvature - path[i - 1].curvature) > 1e-6;
    return changes;
  }
  /** Where its vertices are: x, y, heading, z. */
  static std::set<std::array<double, 4>> posesOf(const semantic_planning::Roadmap& roadmap) {
    std::set<std::array<double, 4>> poses;
    for (colored_graph::VertexId v = 0; v < roadmap.graph().vertexIdEnd(); ++v)
      if (roadmap.graph().containsVertex(v)) {
        const semantic_planning::GroundPose& g = roadmap.pose(v);
        poses.insert({g.pose.x, g.pose.y, g.pose.phi, double(g.z)});
      }
    return poses;
  }
  void expectDrivable(const PlanResult& plan) {
    ASSERT_TRUE(plan.found()) << plan.reason;
    PathChecker(world.map(), options.vehicle).expectDrivable(plan.path);
    EXPECT_NEAR(plan.path.front().x, start.x, 1e-6);
    EXPECT_NEAR(plan.path.front().y, start.y, 1e-6);
    EXPECT_NEAR(plan.path.back().x, goal.x, 1e-4);
    EXPECT_NEAR(plan.path.back().y, goal.y, 1e-4);
    EXPECT_NEAR(std::remainder(plan.path.back().heading - goal.phi, 2 * M_PI), 0, 1e-4);
    EXPECT_NEAR(plan.path.back().arcLength, plan.length, 0.01 * plan.length);
  }

  PaintedWorld world;
  colored_graph::ClassOrder order{5, {{1}, {2}, {4}, {0}}};
  semantic_planning::PlannerOptions options;
  TPose2D start{-10, -13, M_PI / 2}, goal{13, 10, 0};
};
