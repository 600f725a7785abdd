#pragma once
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>

#include "PaintedWorld.h"

/** The benchmarks' map: 100 x 100 m, blocks of houses in grass, with streets of 6 m every 25 m. */
namespace town {

constexpr double kHalf = 50;  // m

inline const colored_graph::ClassOrder& order() {
  static const colored_graph::ClassOrder order(5, {{1}, {2}, {4}, {0}});
  return order;
}

inline PaintedWorld world() {
  PaintedWorld world;
  world.floor(-kHalf, kHalf, -kHalf, kHalf, PaintedWorld::Grass);
  for (double at = -50; at < 50; at += 25) {
    world.floor(at, at + 6, -kHalf, kHalf, PaintedWorld::Road);
    world.floor(-kHalf, kHalf, at, at + 6, PaintedWorld::Road);
  }
  for (double x = -50; x < 50; x += 25)
    for (double y = -50; y < 50; y += 25) {
      world.box(x + 10, x + 15, y + 10, y + 19, 0, 2, PaintedWorld::Wall);
      world.floor(x + 18, x + 21, y + 10, y + 15, PaintedWorld::Mud);
    }
  return world;
}

/** Keeps G-values of the order. */
inline semantic_octree::SemanticOcTree& map() {
  static PaintedWorld painted = world();
  static semantic_octree::SemanticOcTree& map = painted.map({0.05, 0.05, 60});
  if (!hasAbstraction(map)) setAbstraction(map, semantic_planning::abstractionFor(order()));
  return map;
}

}  // namespace town
