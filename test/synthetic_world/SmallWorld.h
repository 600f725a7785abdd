#pragma once
#include <synthetic_world/World.h>

#include "TemporaryFolder.h"

/** Worlds so simple that the answers are known. */
namespace small_world {

using namespace synthetic_world;

inline World flat(Solids solids = {}, int halfExtent = 30) {
  return World(Terrain(halfExtent, {}), GroundCover(halfExtent, kGrass), std::move(solids));
}

inline Solid box(const Eigen::Vector2d& center, const Eigen::Vector2d& size, double low,
                 double high, Material side, Material top) {
  const Polygon outline = rectangle(center, 0, size.x(), size.y());
  return {Polyhedron(outline, outline, low, high), side, top};
}

/** A wall of 1 m whose near face is the plane x = 5. */
inline World withWall() { return flat({box({5.5, 0}, {1, 40}, -1, 8, kWall, kRoof)}); }

}  // namespace small_world
