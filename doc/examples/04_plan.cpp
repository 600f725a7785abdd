// Plans a path over a map that puts classes before length:
//     04_plan MAP.semantic ORDER.yaml X Y HEADING X Y HEADING      (meters, degrees)
#include <semantic_abstraction/Abstraction.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_planning/planner/OrderFile.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <cstdlib>
#include <iostream>

using namespace semantic_octree;
using namespace semantic_planning;

mrpt::math::TPose2D pose(char** arg) {
  return {std::atof(arg[0]), std::atof(arg[1]), std::atof(arg[2]) * M_PI / 180};
}

int main(int argc, char** argv) try {
  if (argc != 9) throw std::invalid_argument("expected a map, an order and two poses");
  const mrpt::math::TPose2D start = pose(argv + 3), goal = pose(argv + 6);

  SemanticOcTree map = loadTree(argv[1]);
  const CellState below =
      map.castRay(octomap::point3d(start.x, start.y, 2), {0, 0, -1}).value().state;
  std::cout << "starts on " << map.classes().name(below.likeliestClass) << "\n";

  const auto order = loadClassOrder(argv[2], map.classes());  // road before grass before ...
  setAbstraction(map, abstractionFor(order));                 // keeps what the order tells apart
  std::cout << Abstraction(map).leaves().size() << " of " << map.getNumLeafNodes() << " leaves\n";

  SemanticPlanner planner(map, order);
  const PlanResult plan = planner.plan(start, goal);
  std::cout << (plan.found() ? std::to_string(plan.length) + " m" : plan.reason) << "\n";
  return plan.found() ? 0 : 2;
} catch (const std::exception& e) {
  std::cerr << "error: " << e.what() << "\n";
  return 1;
}
