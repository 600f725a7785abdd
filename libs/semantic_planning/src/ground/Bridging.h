#pragma once
#include "Bridges.h"

namespace semantic_planning {

/** The measured surfaces of a tile with those that bridge its holes: of bridges at about one height
 * the shortest. \param bridges of the tile and of all within their reach */
SurfaceTile bridgedSurfaces(const BridgeGrid& bridges, const SurfaceGrid& measured, Column tile,
                            const GroundShape& shape);

}  // namespace semantic_planning
