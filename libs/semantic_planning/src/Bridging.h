#pragma once
#include "ColumnScan.h"
#include "GroundShape.h"
#include "SurfaceTile.h"

namespace semantic_planning {

using ColumnGrid = TileGrid<ColumnTile>;

/** Top voxels with room above. */
SurfaceTile measuredSurfaces(const ColumnTile& columns, const GroundShape& shape);

/** The measured surfaces of a tile with those that bridge its holes. A hole is bridged by the
 * shortest of the lines along the axes and diagonals that do. */
SurfaceTile bridgedSurfaces(const ColumnGrid& columns, const SurfaceGrid& measured, Column tile,
                            const GroundShape& shape);

}  // namespace semantic_planning
