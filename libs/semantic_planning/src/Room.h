#pragma once
#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** Sets Surface::room2 of a tile: exact, from the surfaces within the farthest room.
 * \param surfaces with `drivable` set. */
void measureRoom(const SurfaceGrid& surfaces, Column tile, SurfaceTile& measured,
                 const GroundShape& shape);

}  // namespace semantic_planning
