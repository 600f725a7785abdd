#pragma once
#include "GapFills.h"

namespace semantic_planning {

/** The measured surfaces of a tile with those that fill its holes: of fills at about one height
 * the shortest. Without ghosts: surfaces below others, see ColumnTile. \param fills of the tile and
 * of all within their reach */
SurfaceTile filledSurfaces(const GapFillGrid& fills, const SurfaceGrid& measured,
                           const ScanGrid& columns, Column tile, const GroundShape& shape);

}  // namespace semantic_planning
