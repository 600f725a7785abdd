#pragma once
#include <semantic_planning/ground/Ground.h>

#include <random>

#include "PaintedWorld.h"

/** The ground of a world that was painted. */
namespace painted_ground {

using namespace semantic_planning;
using semantic_octree::SemanticOcTree;

constexpr int kOrigin = semantic_octree::kKeyOfOrigin;

inline colored_graph::ClassOrder anyClass() { return {5, {{0, 1, 2, 3, 4}}}; }

/** A robot of 1 m in height that needs no clearance, and no gap fills. */
inline VehicleOptions smallVehicle() {
  VehicleOptions vehicle;
  vehicle.footprint = Footprint::rectangle(-0.1, 0.1, 0.2);
  vehicle.clearance = 0;
  vehicle.maxSlope = 80;
  return vehicle;
}

inline GroundOptions withoutGapFills() {
  GroundOptions options;
  options.fillGap = options.unknownGap = 0;
  return options;
}

inline Ground groundOf(const SemanticOcTree& map, const VehicleOptions& vehicle = smallVehicle(),
                       const GroundOptions& options = withoutGapFills()) {
  return Ground(map, vehicle, options, anyClass());
}

inline void addRubble(PaintedWorld& world, unsigned seed, int voxels) {
  std::mt19937 random(seed);
  for (int i = 0; i < voxels; ++i)
    world.voxel(int(random() % 40) - 20, int(random() % 40) - 20, int(random() % 14) - 7,
                PaintedWorld::Class(1 + random() % 4));
}

}  // namespace painted_ground
