#pragma once
#include "ColumnBox.h"
#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

/** Marks the surfaces of a tile that are not too steep as drivable.
 * \param marked the tile, in `surfaces` \return the columns whose marks changed. */
ColumnBox markDrivable(const SurfaceGrid& surfaces, Column tile, SurfaceTile& marked,
                       const GroundShape& shape);

}  // namespace semantic_planning
