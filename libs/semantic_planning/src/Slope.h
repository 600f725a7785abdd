#pragma once
#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** Marks the surfaces of a tile that are not too steep as drivable. \param tile of `surfaces`. */
void markDrivable(const SurfaceGrid& surfaces, Column tile, SurfaceTile& marked,
                  const GroundShape& shape);

}  // namespace semantic_planning
