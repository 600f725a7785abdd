// A small robot: it maps what it sees, compresses the map after each scan, and drives to its goal.
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cmath>
#include <iostream>

#include "World.h"

using mrpt::math::TPose2D;
using semantic_map::CSemanticOctoMap;
using semantic_planning::PlanResult;
using semantic_planning::SemanticPlanner;

/** The classes of the map, in the order of their ids. */
semantic_types::ClassTable makeClasses() {
  semantic_types::ClassTable classes;
  classes.add("road", {128, 64, 128});
  classes.add("grass", {80, 180, 60});
  classes.add("wall", {120, 120, 120});
  return classes;
}

/** Where the sensor is: 1.5 m above the robot's origin. */
Eigen::Isometry3d sensorPose(const TPose2D& robot) {
  Eigen::Isometry3d T_map_sensor = Eigen::Isometry3d::Identity();
  T_map_sensor.translation() = Eigen::Vector3d(robot.x, robot.y, 1.5);
  T_map_sensor.linear() = Eigen::AngleAxisd(robot.phi, Eigen::Vector3d::UnitZ()).matrix();
  return T_map_sensor;
}

/** The pose that far along the path, m, or its end. */
TPose2D along(const PlanResult& plan, double distance) {
  auto point = plan.path.begin();
  while (point + 1 != plan.path.end() && point->arcLength < distance) ++point;
  return {point->x, point->y, point->heading};
}

int main() {
  // The map: voxels of 0.2 m that keep what tells roads and walls apart, and drop grass.
  CSemanticOctoMap map(0.2, makeClasses());
  semantic_map::TAbstractionOptions abstraction;
  abstraction.relevant = "road: 1, wall: 1";
  abstraction.irrelevant = "grass: 0.2";
  map.setAbstraction(abstraction);

  // The planner: rather on the road than on grass, never into a wall, unknown ground last.
  const colored_graph::ClassOrder order(4, {{world::kRoad}, {world::kGrass}, {0}});
  semantic_planning::PlannerOptions options;
  options.roadmap.vertices = 400;
  SemanticPlanner planner(map.tree(), order, options);

  TPose2D robot(0, 0, 0);
  const TPose2D goal(20, 4.5, 0);
  for (int step = 0; step < 20; ++step) {
    const Eigen::Isometry3d T_map_sensor = sensorPose(robot);
    map.tree().insert(world::scanFrom(T_map_sensor), T_map_sensor);
    const CSemanticOctoMap::Ptr compressed = map.compress();
    std::cout << "scan " << step << ": " << map.tree().getNumLeafNodes() << " leaves, compressed "
              << compressed->tree().getNumLeafNodes() << "\n";

    planner.update();  // its ground follows the map
    const PlanResult plan = planner.plan(robot, goal);
    if (!plan.found()) {
      std::cerr << "no path: " << plan.reason << "\n";
      return 1;
    }
    std::cout << "  at (" << robot.x << ", " << robot.y << "), " << plan.length << " m to go, "
              << plan.lengthPerClass[world::kRoad] << " m of them on the road\n";
    if (plan.length < 0.5) return 0;
    robot = along(plan, 3.0);
    robot.y += 0.02;  // wheels slip
  }
  std::cerr << "not there after 20 scans\n";
  return 1;
}
